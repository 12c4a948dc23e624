"""More work than the service can do: what is refused, and that nothing is computed for nobody."""

import json
import socket
from concurrent.futures import ThreadPoolExecutor

import pytest
from conftest import LONG, LONG_FLAGS, ORBIT, Service, wait_for

CLIENTS = 60


@pytest.fixture(scope="module")
def cost(tmp_path_factory):
    """The processor time of one orbit, s: what is too much depends on the machine."""
    service = Service(tmp_path_factory.mktemp("service"))
    assert service.simulate(ORBIT).status == 200
    seconds = service.cpu_seconds()
    service.end()
    return seconds


def test_one_request_too_many_is_refused_at_once(start):
    service = start("--workers", "1", "--queue", "0", *LONG_FLAGS)
    with ThreadPoolExecutor() as pool:
        running = pool.submit(service.simulate, LONG)
        service.wait_until_busy()
        refused = service.simulate(ORBIT)
        live, ready = service.get("/health/live"), service.get("/health/ready")
        # All of this came while the first was still computed.
        assert not running.done()
        assert refused.status == 503
        assert refused.problem()["type"] == "/problems/busy"
        assert int(refused.headers["retry-after"]) >= 1
        assert live.status == 200
        assert ready.status == 503
        assert json.loads(ready.body) == {"status": "busy"}
        assert running.result().status == 200
    wait_for(service.is_ready)


def test_after_the_deadline_nothing_is_computed_any_more(start, cost):
    # Long enough for a body to arrive where the machine is busy, and no flight is over by then.
    service = start("--workers", "1", "--queue", str(CLIENTS), "--deadline", str(cost / 4))
    with ThreadPoolExecutor(CLIENTS) as pool:
        answers = list(pool.map(service.simulate, [ORBIT] * CLIENTS))
    for answer in answers:
        assert answer.status == 504
        assert answer.problem()["type"] == "/problems/deadline-exceeded"
    service.wait_until_idle()
    assert service.cpu_seconds() < CLIENTS * cost / 3
    assert service.is_ready()


def test_nothing_is_computed_for_clients_that_have_gone(start, cost):
    service = start("--workers", "1", "--queue", str(CLIENTS // 2), "--deadline", "300")
    body = json.dumps(ORBIT)
    request = f"POST /simulate HTTP/1.1\r\nhost: x\r\ncontent-type: application/json\r\ncontent-length: {len(body)}\r\n\r\n{body}"
    clients = [socket.create_connection(("127.0.0.1", service.port)) for _ in range(CLIENTS)]
    for client in clients:
        client.sendall(request.encode())
    service.wait_until_busy()
    for client in clients:
        client.close()
    service.wait_until_idle()
    assert service.cpu_seconds() < CLIENTS / 2 * cost / 3
    assert service.is_ready()
    assert "client went away" in service.log.read_text()
