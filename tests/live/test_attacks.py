"""What once hurt the service: each of these silenced it, filled it, or was answered without a word."""

import gzip
import json
import re
import signal
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path

import pytest
from conftest import ORBIT, PATIENCE, wait_for
from test_hostile import metric, open_connection, resident

JSON = {"content-type": "application/json"}
QUICK = {**ORBIT, "stop": {"time": 1}}
# Under 600 bytes that cost some seconds: a long flight, and everything that may be asked for.
COSTLY = {**ORBIT, "sensitivities": True, "verify": True}
ROWS = {**QUICK, "stop": {"time": 1000}, "output": {"count": 20_000}}
STATE = {"state": {"type": "ecef", "position": [7e6, 0, 0], "velocity": [0, 7e3, 0]}}
# Whoever asks from here may say for whom.
PROXY = ("--trusted-proxies", "127.0.0.0/8")


def client(number):
    """The header that tells clients behind a proxy apart."""
    return {"x-forwarded-for": f"203.0.113.{number}"}


def send(service, path, body, headers, length=None):
    """A connection with the bytes of a request, of which more may be announced than are sent."""
    fields = {"host": "x", **JSON, **headers, "content-length": len(body) if length is None else length}
    head = f"POST {path} HTTP/1.1\r\n" + "".join(f"{name}: {value}\r\n" for name, value in fields.items()) + "\r\n"
    connection = open_connection(service)
    connection.sendall(head.encode() + body)
    return connection


@contextmanager
def closing(connections):
    """Closes them in the end."""
    try:
        yield connections
    finally:
        for connection in connections:
            connection.close()


def singles_are_served(service, **headers):
    """Whether others notice nothing."""
    case, state = json.dumps(QUICK), json.dumps(STATE)
    assert service.request("POST", "/simulate", case, {**JSON, **headers}).status == 200
    assert service.request("POST", "/convert", state, {**JSON, **headers}).status == 200
    assert service.get("/docs/").status == 200
    assert service.is_ready()


@pytest.mark.parametrize("clients", [1, 33])
def test_unfinished_uploads_silence_nothing(start, clients):
    service = start(*PROXY)
    length = 8 << 20
    body = b" " * (length - 1)
    with ThreadPoolExecutor(33) as pool:
        uploads = list(pool.map(lambda number: try_to_send(service, body, length, client(number % clients)), range(33)))
    with closing([upload for upload in uploads if upload]):
        # As many as there is room for are held.
        assert metric(service, "reentry_held_bytes") <= 32 << 20
        for _ in range(20):
            singles_are_served(service)
        # The slow ones are given up soon, and batches served, before any of them is at its deadline.
        begin = time.monotonic()
        wait_for(lambda: service.request("POST", "/simulate/batch", json.dumps([QUICK]), {**JSON, **client(99)}).status == 200)
        print(f"the first batch after {time.monotonic() - begin} s")


def try_to_send(service, body, length, headers):
    try:
        return send(service, "/simulate/batch", body, headers, length)
    except OSError:
        # Refused before it was sent.
        return None


def test_a_client_holds_half_of_what_bodies_may_take(start):
    service = start(*PROXY)
    body = b" " * ((8 << 20) - 1)
    with closing([send(service, "/simulate/batch", body, client(1), 8 << 20) for _ in range(2)]):
        wait_for(lambda: metric(service, "reentry_held_bytes") >= 16 << 20)
        again = service.request("POST", "/simulate/batch", json.dumps([QUICK]), {**JSON, **client(1)})
        assert again.problem()["type"] == "/problems/too-many-requests"
        other = service.request("POST", "/simulate/batch", json.dumps([QUICK]), {**JSON, **client(2)})
        assert other.status == 200


def test_readers_who_do_not_read_hold_no_slot_of_a_batch(start):
    # Of 512 MiB what they are behind would be so much that they are hurried.
    memory = ("--memory", str(2 << 30))
    service = start(*PROXY, *memory, "--batches", "4", "--deadline", "300", "--batch-deadline", "300", "--idle", "300")
    body = json.dumps([ROWS] * 20).encode()
    with closing([]) as readers:
        for number in range(8):
            readers.append(send(service, "/simulate/batch", body, client(number)))
            # It has computed what its reader may be behind.
            service.wait_until_idle()
        for _ in range(4):
            answer = service.request("POST", "/simulate/batch", json.dumps([QUICK] * 3), {**JSON, **client(99)})
            assert answer.status == 200
            assert len(answer.body.splitlines()) == 3
        # Who begins to read is given the rest.
        readers[0].settimeout(PATIENCE)
        text = b""
        while not text.endswith(b"\r\n0\r\n\r\n"):
            text += readers[0].recv(1 << 20)
        assert text.count(b'"warnings"') == 20
    wait_for(lambda: metric(service, "reentry_held_bytes") == 0)


def test_a_client_has_half_of_the_slots_of_batches(start):
    service = start(*PROXY, "--batches", "4", "--deadline", "300", "--batch-deadline", "300")
    body = json.dumps([QUICK] + [{**ORBIT, "stop": {"time": 1e9}}] * 100).encode()
    with closing([send(service, "/simulate/batch", body, client(1)) for _ in range(2)]) as batches:
        for batch in batches:
            batch.recv(1000)
        again = service.request("POST", "/simulate/batch", json.dumps([QUICK]), {**JSON, **client(1)})
        assert again.problem()["type"] == "/problems/too-many-requests"
        other = service.request("POST", "/simulate/batch", json.dumps([QUICK]), {**JSON, **client(2)})
        assert other.status == 200


def test_costly_requests_give_way_to_short_ones(start):
    service = start("--workers", "2", "--queue", "64", "--deadline", "300")
    body = json.dumps(COSTLY).encode()
    assert len(body) < 600
    # As many as may be suspended: of one more, one is refused where a short one needs the worker of the last.
    with closing([send(service, "/simulate", body, {}) for _ in range(64)]) as costly:
        wait_for(lambda: metric(service, "reentry_jobs_suspended") >= 30)
        # Before, there was no place for any, and those before them took half a minute.
        for _ in range(50):
            singles_are_served(service)
        assert metric(service, "reentry_jobs_suspended") >= 20
        # They are finished one after another: sixty-four of some seconds, on two workers.
        costly[0].settimeout(3 * PATIENCE)
        assert costly[0].recv(1000).startswith(b"HTTP/1.1 200 ")
    wait_for(lambda: metric(service, "reentry_jobs_suspended") == 0)


def test_a_flood_of_all_kinds_stays_within_its_memory_and_gives_it_back(start):
    memory = 128 << 20
    service = start(*PROXY, "--memory", str(memory), "--row-limit", "100000", "--body-limit", str(1 << 20), "--idle", "5", "--workers", "2")
    before = resident(service)
    rows = json.dumps({**QUICK, "stop": {"time": 10_000}, "output": {"count": 60_000}}).encode()
    orbit = json.dumps({**ORBIT, "stop": {"time": 1e9}}).encode()
    batch = json.dumps([{**ROWS, "output": {"count": 50_000}}] * 20).encode()
    body = b" " * ((1 << 20) - 1)
    connections = []
    peak = 0
    for round_number in range(6):
        for number in range(12):
            who = client(20 * round_number + number)
            for path, content, length in [
                ("/simulate", rows, None),
                ("/simulate", orbit, None),
                ("/simulate/batch", batch, None),
                ("/simulate", body, 1 << 20),
                ("/simulate/batch", b" " * (4 << 20), 8 << 20),
            ]:
                try:
                    connections.append(send(service, path, content, who, length))
                except OSError:
                    pass
            peak = max(peak, resident(service))
        time.sleep(0.5)
        peak = max(peak, resident(service))
        singles_are_served_or_refused(service)
    print(f"before {before / 1e6:.0f} MB, peak {peak / 1e6:.0f} MB")
    # What the guide says of containers.
    assert peak < memory + 64e6 + 24e3 * len(connections)
    for connection in connections:
        connection.close()
    wait_for(lambda: metric(service, "reentry_held_bytes") == 0)
    service.wait_until_idle()
    wait_for(lambda: resident(service) < before + 40e6)
    print(f"after {resident(service) / 1e6:.0f} MB")


def singles_are_served_or_refused(service):
    assert service.simulate(QUICK).status in (200, 503)


def test_a_body_may_come_in_a_coding(service):
    text = json.dumps(QUICK)
    plain = json.loads(service.simulate(QUICK).body)
    for coding, body in [("gzip", gzip.compress(text.encode())), ("zstd", zstd(text)), ("identity", text.encode()), ("GZIP", gzip.compress(text.encode()))]:
        answer = service.request("POST", "/simulate", body, {**JSON, "content-encoding": coding})
        assert answer.status == 200, answer.body
        assert json.loads(answer.body)["final_state"] == plain["final_state"]
    batch = service.request("POST", "/simulate/batch", gzip.compress(json.dumps([QUICK] * 3).encode()), {**JSON, "content-encoding": "gzip"})
    assert len(batch.body.splitlines()) == 3
    for coding in ["br", "deflate", "gzip, gzip", "x"]:
        refused = service.request("POST", "/simulate", text, {**JSON, "content-encoding": coding})
        assert refused.status == 415
        assert refused.problem()["type"] == "/problems/unsupported-coding"
        assert "gzip, zstd" in refused.problem()["detail"]
        assert refused.headers["accept-encoding"] == "gzip, zstd"
    # Bombs are longer than a body may be, and what is not coded so is said not to be.
    bomb = service.request("POST", "/simulate", gzip.compress(b" " * (50 << 20)), {**JSON, "content-encoding": "gzip"})
    assert bomb.problem()["type"] == "/problems/payload-too-large"
    for body in [b"", b"text", gzip.compress(text.encode())[:-9], gzip.compress(text.encode()) + b"x"]:
        wrong = service.request("POST", "/simulate", body, {**JSON, "content-encoding": "gzip"})
        assert wrong.problem()["type"] == "/problems/unreadable-body"
        assert "gzip" in wrong.problem()["detail"]


def test_members_of_gzip_without_a_text_are_given_up_with_their_client(start):
    service = start("--workers", "1", "--deadline", "0.2")
    member = gzip.compress(b"")
    body = member * ((8 << 20) // len(member))
    before = service.cpu_seconds()
    late = service.request("POST", "/simulate/batch", body, {**JSON, "content-encoding": "gzip"})
    assert late.problem()["type"] == "/problems/deadline-exceeded"
    service.wait_until_idle()
    # All of them would take a second.
    assert service.cpu_seconds() < before + 0.5


def test_the_tree_of_a_case_counts_as_held(start):
    memory = 64 << 20
    service = start("--memory", str(memory))
    for case in [b'{"a":[' + b"1," * 1_000_000 + b"1]}", b'{"a":[' + b"[]," * 700_000 + b"1]}"]:
        answer = service.request("POST", "/simulate/batch", b"[" + case + b"]", JSON)
        assert json.loads(answer.body)["type"] == "/problems/answer-too-large"
    assert service.request("POST", "/simulate/batch", b"[" + b"1," * 3_000_000 + b"1]", JSON).status == 422
    status = Path(f"/proc/{service.process.pid}/status").read_text()
    peak = 1024 * int(next(line for line in status.splitlines() if line.startswith("VmHWM:")).split()[1])
    assert peak < memory + 64e6


def zstd(text):
    """A frame with one raw block (RFC 8878, section 3.1.1), which needs no library."""
    content = text.encode()
    assert 256 <= len(content) < 65536 + 256
    # A single segment whose content size has two bytes.
    head = b"\x28\xb5\x2f\xfd" + bytes([0b0110_0000]) + (len(content) - 256).to_bytes(2, "little")
    return head + (len(content) << 3 | 1).to_bytes(3, "little") + content


@pytest.mark.parametrize(
    ("head", "status", "kind"),
    [
        (b"GET /health/live HTTP/1.1\r\nconnection: close\r\n\r\n", 400, "malformed-request"),
        (b"GET /health/live HTTP/1.1\r\nhost: a\r\nhost: b\r\nconnection: close\r\n\r\n", 400, "malformed-request"),
        (b"GET /health/live HTTP/1.1\r\nhost: a b\r\nconnection: close\r\n\r\n", 400, "malformed-request"),
        (
            b"POST /simulate HTTP/1.1\r\nhost: x\r\ntransfer-encoding: gzip, chunked\r\nconnection: close\r\n\r\n0\r\n\r\n",
            400,
            "malformed-request",
        ),
        (b"GET /health/live HTTP/9.9\r\nhost: x\r\n\r\n", 400, "malformed-request"),
        (b"garbage\r\n\r\n", 400, "malformed-request"),
        (b"POST /simulate HTTP/1.1\r\nhost: x\r\ncontent-length: -5\r\n\r\n", 400, "malformed-request"),
        (b"GET /health/live HTTP/1.1\r\nhost: x\r\n" + b"x: y\r\n" * 200 + b"\r\n", 431, "head-too-large"),
        (b"GET /health/live HTTP/1.1\r\nhost: x\r\nx: " + b"y" * 100_000, 431, "head-too-large"),
    ],
)
def test_what_is_no_request_has_a_problem_document_an_identifier_and_a_line(service, head, status, kind):
    connection = open_connection(service)
    try:
        connection.sendall(head)
    except OSError:
        # Refused before it was sent.
        pass
    text = b""
    try:
        while part := connection.recv(1 << 16):
            text += part
    except ConnectionResetError:
        # What it had not read was still on its way.
        pass
    connection.close()
    head, _, body = text.partition(b"\r\n\r\n")
    assert head.startswith(f"HTTP/1.1 {status} ".encode()), text
    assert b"\r\ncontent-type: application/problem+json\r\n" in head + b"\r\n"
    assert f"\r\ncontent-length: {len(body)}\r\n".encode() in head + b"\r\n"
    problem = json.loads(body)
    assert problem["type"] == f"/problems/{kind}"
    assert problem["status"] == status
    identifier = re.search(rb"x-request-id: (\S+)", head)[1].decode()
    line = wait_for(lambda: [line for line in service.log.read_text().splitlines() if identifier in line])
    assert f"status={status}" in line[0]
    assert metric(service, "reentry_requests_total") > 0


def test_a_request_without_a_host_is_one_of_http_1_0(service):
    connection = open_connection(service)
    connection.sendall(b"GET /health/live HTTP/1.0\r\n\r\n")
    assert connection.recv(1000).startswith(b"HTTP/1.0 200 ")
    connection.close()


def test_garbage_after_a_request_is_told_in_its_turn(service):
    connection = open_connection(service)
    connection.sendall(b"GET /health/live HTTP/1.1\r\nhost: x\r\n\r\n" * 3 + b"garbage\r\n\r\n")
    text = b""
    while part := connection.recv(1 << 16):
        text += part
    connection.close()
    assert text.count(b"HTTP/1.1 200 ") == 3
    assert text.count(b'{"status":"ok"}') == 3
    assert b"/problems/malformed-request" in text.split(b"HTTP/1.1 400 ")[1]


def test_sighup_changes_nothing_and_sigquit_ends_as_sigterm_does(start):
    service = start()
    service.process.send_signal(signal.SIGHUP)
    wait_for(lambda: "SIGHUP has no effect" in service.log.read_text())
    assert service.simulate(QUICK).status == 200
    service.process.send_signal(signal.SIGQUIT)
    assert service.process.wait(PATIENCE) == 0
    assert "shutting down" in service.log.read_text()
