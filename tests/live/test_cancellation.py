"""Work for a client that has gone ends wherever it is: in the flight, its rows, their text, or its compression."""

import json
import socket
import time

import pytest
from conftest import ORBIT, PATIENCE

ROWS = {**ORBIT, "stop": {"time": 100_000}, "output": {"count": 100_000}}
DATED = {**ROWS, "epoch": "2026-01-01T00:00:00Z"}
# In which parts of the time that the whole takes the client goes away.
INSTANTS = [0.1, 0.2, 0.3, 0.4, 0.5]


def post(path, body, **fields):
    text = json.dumps(body)
    fields = {"host": "x", "content-type": "application/json", "content-length": len(text), **fields}
    return f"POST {path} HTTP/1.1\r\n" + "".join(f"{name}: {value}\r\n" for name, value in fields.items()) + f"\r\n{text}"


def connection(service, text):
    client = socket.create_connection(("127.0.0.1", service.port), PATIENCE)
    client.sendall(text.encode())
    return client


@pytest.mark.parametrize(
    "text",
    [
        post("/simulate", ORBIT),
        post("/simulate", ROWS),
        post("/simulate?format=csv", ROWS),
        post("/simulate?format=geojson", DATED),
        post("/simulate?format=kml", DATED),
        post("/simulate?format=czml", ROWS),
        post("/simulate?format=oem", DATED),
        post("/simulate", ROWS, **{"accept-encoding": "gzip"}),
        post("/simulate", {**ORBIT, "sensitivities": True}),
        post("/simulate", {**ORBIT, "verify": True}),
        post("/simulate/batch", [ROWS] * 3),
    ],
    ids=["flight", "rows", "csv", "geojson", "kml", "czml", "oem", "gzip", "sensitivities", "verify", "batch"],
)
def test_a_client_that_goes_away_takes_its_work_along(start, text):
    service = start("--workers", "1")
    begin, before = time.monotonic(), service.cpu_seconds()
    with connection(service, text.replace("host:", "connection: close\r\nhost:")) as client:
        assert client.recv(12) == b"HTTP/1.1 200"
        while client.recv(1 << 20):
            pass
    whole, cost = time.monotonic() - begin, service.cpu_seconds() - before
    after = 0
    for instant in INSTANTS:
        with connection(service, text):
            time.sleep(instant * whole)
            before = service.cpu_seconds()
        service.wait_until_idle()
        after += service.cpu_seconds() - before
    # Uncancelled, each would go on for at least half of it.
    assert after < len(INSTANTS) * cost / 4, (after, cost)
