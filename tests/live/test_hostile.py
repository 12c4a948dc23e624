"""Clients that are slow, silent, gone, or speak no HTTP: they hurt neither each other nor the service."""

import json
import random
import resource
import socket
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from conftest import ORBIT, PATIENCE, wait_for

QUICK = {**ORBIT, "stop": {"time": 1}}
# An answer far longer than the system's own buffers of a connection: 100 000 rows, some 40 MB.
HUGE = {**ORBIT, "stop": {"time": 10_000}, "output": {"count": 100_000}}
MANY = 10_000
# What a connection may cost that does nothing, and one that has sent part of a head, bytes.
IDLE_COST = 16_000
HEAD_COST = 24_000


def head(body, **more):
    """A request of a case, and its head alone."""
    fields = {"host": "x", "content-type": "application/json", "content-length": len(body), **more}
    return "POST /simulate HTTP/1.1\r\n" + "".join(f"{name}: {value}\r\n" for name, value in fields.items()) + "\r\n"


def open_connection(service):
    return socket.create_connection(("127.0.0.1", service.port), PATIENCE)


def request(case):
    body = json.dumps(case)
    return (head(body) + body).encode()


def resident(service):
    """Its memory, bytes."""
    status = Path(f"/proc/{service.process.pid}/status").read_text()
    return 1024 * int(next(line for line in status.splitlines() if line.startswith("VmRSS:")).split()[1])


def metric(service, name):
    """The sum of a metric over its labels."""
    lines = service.get("/metrics").body.decode().splitlines()
    return sum(float(line.split()[-1]) for line in lines if line.split("{")[0].split(" ")[0] == name)


def is_closed(client):
    """Whether the service ends the connection while one waits."""
    client.settimeout(PATIENCE)
    try:
        while client.recv(1 << 20):
            pass
    except ConnectionResetError:
        pass
    return True


@pytest.fixture
def files():
    """As many open files as there may be."""
    before = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (before[1], before[1]))
    yield before[1]
    resource.setrlimit(resource.RLIMIT_NOFILE, before)


@pytest.mark.parametrize(("said", "cost"), [(b"", IDLE_COST), (b"POST /simulate HTTP/1.1\r\nhost: x\r\nx: ", HEAD_COST)])
def test_ten_thousand_connections_that_do_nothing_are_in_nobodys_way(start, files, said, cost):
    if files < MANY + 100:
        pytest.skip(f"this machine allows {files} open files")
    service = start("--idle", "20")
    assert service.simulate(QUICK).status == 200
    before = resident(service)
    clients = [open_connection(service) for _ in range(MANY)]
    for client in clients:
        if said:
            client.sendall(said)
    wait_for(lambda: metric(service, "reentry_connections") > MANY)
    assert service.simulate(QUICK).status == 200
    assert resident(service) < before + MANY * cost
    # All of them are let go in time, and those that come later are as welcome.
    for client in clients:
        assert is_closed(client)
        client.close()
    wait_for(lambda: metric(service, "reentry_connections") < 10)
    assert service.simulate(QUICK).status == 200


def test_more_connections_than_there_may_be_wait_for_their_turn(start):
    service = start("--connections", "3", "--idle", "1")
    idle = [open_connection(service) for _ in range(3)]
    # The fourth is answered as soon as one of the three has been idle for too long.
    assert service.simulate(QUICK).status == 200
    for client in idle:
        client.close()


@pytest.mark.parametrize("part", [32, -200], ids=["in the head", "in the body"])
def test_a_client_that_sends_a_byte_at_a_time_gets_no_longer_than_others(start, part):
    service = start("--idle", "1", "--deadline", "1")
    whole = request(QUICK)
    slow = open_connection(service)
    slow.sendall(whole[:part])
    sent = 0
    slow.settimeout(0.1)
    answer = None
    while answer is None:
        assert sent < PATIENCE / 0.1
        try:
            slow.sendall(b"a")
            sent += 1
            answer = slow.recv(1000)
        except TimeoutError:
            assert service.simulate(QUICK).status == 200
        except (BrokenPipeError, ConnectionResetError):
            answer = b""
    # The head is given up without a word, as there is no request yet.
    assert answer == b"" or answer.startswith(b"HTTP/1.1 408 ")
    assert b"408" in answer or part > 0


def test_answers_that_nobody_takes_are_thrown_away(start):
    # Room for all of them, though they are one client.
    service = start("--idle", "1", "--workers", "2", "--memory", str(2 << 30), "--deadline", "60")
    clients = [open_connection(service) for _ in range(8)]
    for client in clients:
        client.sendall(request(HUGE))
    wait_for(lambda: metric(service, "reentry_connections_stalled_total") == len(clients))
    # The last is counted as stalled a moment before it is gone.
    wait_for(lambda: metric(service, "reentry_held_bytes") == 0)
    assert service.simulate(QUICK).status == 200
    wait_for(lambda: service.log.read_text().count("client went away from its answer") == len(clients))
    for client in clients:
        client.close()


def test_answers_that_nobody_takes_make_room_for_others_where_memory_is_short(start):
    # Patience is long, but not where half of the memory is held.
    memory = 128 << 20
    service = start("--idle", "300", "--memory", str(memory), "--trusted-proxies", "127.0.0.1")
    clients = [open_connection(service) for _ in range(16)]
    for number, client in enumerate(clients):
        body = json.dumps({**HUGE, "output": {"count": 40_000}})
        client.sendall((head(body, **{"x-forwarded-for": f"203.0.113.{number}"}) + body).encode())
    wait_for(lambda: metric(service, "reentry_connections_stalled_total") > 0)
    wait_for(lambda: service.simulate(QUICK).status == 200)
    # The program's own and its allocator's are beside that.
    assert resident(service) < memory + 64e6
    for client in clients:
        client.close()


def test_a_client_that_takes_its_answer_slowly_gets_all_of_it(start):
    service = start("--idle", "1")
    client = open_connection(service)
    client.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 16)
    client.sendall(request({**HUGE, "output": {"count": 5_000}}).replace(b"host:", b"connection: close\r\nhost:"))
    taken = b""
    # Less than the patience goes by between any two, more than it in all.
    for _ in range(8):
        time.sleep(0.5)
        taken += client.recv(1 << 17)
    while part := client.recv(1 << 20):
        taken += part
    text, _, body = taken.partition(b"\r\n\r\n")
    assert text.startswith(b"HTTP/1.1 200 ")
    assert len(json.loads(body)["trajectory"]["time"]) == 5_000
    client.close()


def test_garbage_is_refused_and_costs_nothing(service):
    numbers = random.Random(1)
    texts = [numbers.randbytes(size) for size in [1, 100, 10_000, 1_000_000]]
    texts += [b"\x16\x03\x01\x02\x00\x01", b"GET / HTTP/9.9\r\n\r\n", b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n"]
    texts += [b"GET / HTTP/1.1\r\nhost: x\r\n" + b"x: y\r\n" * 1_000_000, b"GET /" + b"a" * 1_000_000 + b" HTTP/1.1\r\n\r\n"]
    texts += [b"POST /simulate HTTP/1.1\r\nhost: x\r\ntransfer-encoding: chunked\r\n\r\n" + b"zz\r\n" * 1000]
    texts += [b"POST /simulate HTTP/1.1\r\nhost: x\r\ncontent-length: -5\r\n\r\n", b"\r\n" * 100_000]
    service.simulate(QUICK)
    before = resident(service)
    for _ in range(20):
        for text in texts:
            client = open_connection(service)
            try:
                client.sendall(text)
                client.shutdown(socket.SHUT_WR)
            except OSError:
                # It has been shown the door already.
                pass
            assert is_closed(client)
            client.close()
    assert resident(service) < before + 20e6
    assert service.simulate(QUICK).status == 200
    assert "panicked" not in service.log.read_text()


def test_requests_in_a_row_are_answered_in_order_and_garbage_after_them_ends_the_connection(service):
    count = 500
    client = open_connection(service)
    names = [str(index) for index in range(count)]
    text = b"".join(request({**QUICK, "name": name}) for name in names) + b"\x00garbage\r\n\r\n"
    with ThreadPoolExecutor() as pool:
        sending = pool.submit(client.sendall, text)
        answers = b""
        while part := client.recv(1 << 16):
            answers += part
        sending.result()
    assert answers.count(b"HTTP/1.1 200 ") == count
    assert [answers.find(f'"name":"{name}"'.encode()) for name in names] == sorted(
        answers.find(f'"name":"{name}"'.encode()) for name in names
    )
    assert answers.rfind(b"HTTP/1.1 400 ") > answers.rfind(b"HTTP/1.1 200 ")
    client.close()


def test_the_log_has_nothing_of_bodies_headers_and_queries(start):
    secret = "MarkOfSecrecy"
    service = start("--log", "trace")
    case = json.dumps({**QUICK, "name": secret})
    headers = {"content-type": "application/json", "authorization": f"Bearer {secret}", "cookie": secret, "x-more": secret}
    for path in ["/simulate", "/convert", "/analytic", f"/simulate?{secret}=1"]:
        service.request("POST", path, case, headers)
    service.request("POST", "/simulate", f'{{"vehicle": "{secret}"', headers)
    service.request("POST", "/simulate/batch", f"[{case}]", headers)
    log = wait_for(lambda: (text := service.log.read_text()).count("/simulate/batch") and text)
    assert secret not in log
