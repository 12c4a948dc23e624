"""Batches on real sockets: lines come when they are there, to clients that are fast, slow or gone, beside single requests."""

import http.client
import json
import time
import zlib
from concurrent.futures import ThreadPoolExecutor

import pytest
from conftest import LONG_FLAGS, ORBIT, PATIENCE, wait_for

JSON = {"content-type": "application/json"}
QUICK = {**ORBIT, "name": "quick", "stop": {"time": 1}}
BAD = {**QUICK, "name": 5}


def send(service, cases, headers=None):
    """A connection with the answer to a batch of which nothing has been read."""
    connection = service.connect()
    connection.request("POST", "/simulate/batch", json.dumps(cases), {**JSON, **(headers or {})})
    return connection, connection.getresponse()


def batch(service, cases):
    """The lines of a batch."""
    answer = service.request("POST", "/simulate/batch", json.dumps(cases), JSON)
    assert answer.status == 200, answer.body
    assert answer.headers["content-type"] == "application/x-ndjson"
    return [json.loads(line) for line in answer.body.splitlines()]


def test_the_lines_are_in_order_and_a_failing_case_stops_no_other(service):
    cases = [{**QUICK, "name": str(index)} for index in range(1000)]
    cases[0] = {**ORBIT, "name": "0"}
    cases[500] = BAD
    lines = batch(service, cases)
    failed = lines.pop(500)
    assert failed["status"] == 422
    assert failed["errors"] == [{"pointer": "/name", "detail": "must be a string, got a number"}]
    assert [line["name"] for line in lines] == [case["name"] for case in cases if case is not BAD]


def test_more_than_a_thousand_cases_are_refused(service):
    answer = service.request("POST", "/simulate/batch", json.dumps([QUICK] * 1001), JSON)
    assert answer.problem()["errors"] == [{"pointer": "", "detail": "must have at most 1000 cases, got 1001"}]


@pytest.mark.parametrize("encoding", [None, "gzip", "zstd"])
def test_the_first_line_comes_before_the_last_is_computed(service, encoding):
    count = 8
    connection, response = send(service, [QUICK] + [ORBIT] * count, {"accept-encoding": encoding} if encoding else None)
    assert response.headers["content-encoding"] == encoding
    before = service.cpu_seconds()
    first = response.read1(1 << 20)
    if encoding == "zstd":
        # The beginning of a frame alone is shorter.
        assert len(first) > 100
        rest = response.read()
    else:
        unpack = zlib.decompressobj(wbits=31).decompress if encoding else bytes
        text = unpack(first)
        assert json.loads(text.splitlines()[0])["name"] == "quick"
        assert len(text.splitlines()) < count
        rest = response.read()
        # And none is lost on the way.
        assert len((text + unpack(rest)).splitlines()) == count + 1
    assert rest
    # The rest was still to be computed.
    assert service.cpu_seconds() > before
    connection.close()


def test_nothing_is_computed_for_a_client_that_has_gone(start):
    service = start("--batches", "1", "--deadline", "300", "--batch-deadline", "300")
    _ = batch(service, [ORBIT])
    cost = service.cpu_seconds()
    connection, response = send(service, [QUICK] + [ORBIT] * 60)
    assert json.loads(response.readline())["name"] == "quick"
    # The only place for a batch is taken until it is given up.
    assert service.request("POST", "/simulate/batch", json.dumps([QUICK]), JSON).status == 503
    response.close()
    connection.close()
    wait_for(lambda: service.request("POST", "/simulate/batch", json.dumps([QUICK]), JSON).status == 200)
    service.wait_until_idle()
    assert service.cpu_seconds() < 60 * cost / 3


def test_singles_are_answered_while_batches_fly(start):
    service = start("--workers", "2", "--deadline", "300", "--batch-deadline", "300")
    batches = [send(service, [QUICK] + [ORBIT] * 60) for _ in range(6)]
    for _, response in batches:
        response.readline()
    slowest = 0.0
    for _ in range(50):
        start_time = time.monotonic()
        assert service.simulate(QUICK).status == 200
        slowest = max(slowest, time.monotonic() - start_time)
    print(f"slowest single: {slowest} s")
    assert slowest < 10
    assert service.is_ready()
    # All this came while the batches were still flying.
    before = service.cpu_seconds()
    wait_for(lambda: service.cpu_seconds() > before + 1)
    for connection, _ in batches:
        connection.close()


def test_out_of_time_before_the_first_line_is_a_504_and_later_a_line(start):
    service = start("--workers", "1", "--batch-deadline", "1")
    endless = {**ORBIT, "stop": {"time": 1e9}}
    answer = service.request("POST", "/simulate/batch", json.dumps([QUICK] + [endless] * 99), JSON)
    lines = [json.loads(line) for line in answer.body.splitlines()]
    assert len(lines) == 100
    assert lines[-1]["type"] == "/problems/deadline-exceeded"
    assert lines[-1]["detail"] == "the request exceeded the time limit of 1 s"
    hurried = start("--workers", "1", "--batch-deadline", "0.001")
    assert hurried.request("POST", "/simulate/batch", json.dumps([ORBIT]), JSON).problem()["status"] == 504
    service.wait_until_idle()


def test_a_client_that_does_not_read_is_cut_off_and_sees_it(start):
    service = start("--workers", "1", "--batches", "1", "--deadline", "1", "--batch-deadline", "300")
    rows = {**QUICK, "stop": {"time": 1000}, "output": {"count": 20_000}}
    connection, response = send(service, [rows] * 100)
    # Its slot is another's as long as it takes nothing.
    wait_for(lambda: service.request("POST", "/simulate/batch", json.dumps([QUICK]), JSON).status == 200)
    wait_for(lambda: "the batch ended early" in service.log.read_text())
    with pytest.raises((http.client.IncompleteRead, ConnectionResetError)):
        response.read()
    connection.close()


def test_unread_batches_keep_no_worker_from_singles(start):
    service = start("--workers", "1", "--deadline", "300", "--batch-deadline", "300", "--memory", str(2 << 30))
    rows = {**QUICK, "stop": {"time": 1000}, "output": {"count": 20_000}}
    unread = [send(service, [rows] * 100) for _ in range(10)]
    service.wait_until_idle()
    assert service.simulate(QUICK).status == 200
    for connection, _ in unread:
        connection.close()


def test_a_running_batch_is_finished_before_the_service_ends(start):
    service = start("--workers", "1", *LONG_FLAGS)
    connection, response = send(service, [QUICK] + [ORBIT] * 5)
    response.readline()
    service.process.terminate()
    assert len(response.read().splitlines()) == 5
    connection.close()
    assert service.process.wait(PATIENCE) == 0


def test_a_batch_as_long_as_allowed_is_read_and_a_longer_one_refused(service):
    limit = 8 << 20
    assert service.request("POST", "/simulate/batch", b"[1" + b" " * (limit - 3) + b"]", JSON).status == 200
    answer = service.request("POST", "/simulate/batch", b" " * (limit + 1), JSON)
    assert answer.problem()["type"] == "/problems/payload-too-large"
