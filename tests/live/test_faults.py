"""What happens to the program: signals, a full disk, a log that nobody reads."""

import http.client
import json
import os
import signal
import subprocess
import threading

import pytest
from conftest import BINARY, ORBIT, PATIENCE, Service, clean_environment, run, wait_for

CLIENTS = 16
SHORT = {**ORBIT, "stop": {"time": 20_000}}
BODY = json.dumps(SHORT)


class Client(threading.Thread):
    """Asks again and again on one connection, until the service wants no more."""

    def __init__(self, service):
        super().__init__()
        self.service = service
        self.answered = 0
        self.lost = []

    def run(self):
        connection = self.service.connect()
        try:
            while True:
                connection.request("POST", "/simulate", BODY, {"content-type": "application/json"})
                response = connection.getresponse()
                body = response.read()
                if response.status not in (200, 503) or len(body) != int(response.headers["content-length"]):
                    self.lost.append((response.status, body))
                self.answered += 1
                if response.headers["connection"] == "close":
                    return
        except OSError as error:
            # Refused before it was sent, or else lost.
            if not isinstance(error, ConnectionRefusedError):
                self.lost.append(error)
        except http.client.HTTPException as error:
            self.lost.append(error)
        finally:
            connection.close()


@pytest.mark.parametrize("stop", [signal.SIGTERM, signal.SIGINT])
def test_a_stop_signal_under_load_loses_no_request(start, stop):
    service = start()
    clients = [Client(service) for _ in range(CLIENTS)]
    for client in clients:
        client.start()
    wait_for(lambda: all(client.answered for client in clients))
    service.process.send_signal(stop)
    for client in clients:
        client.join(PATIENCE)
    assert [client.lost for client in clients] == [[]] * CLIENTS
    assert service.process.wait(PATIENCE) == 0
    assert "still running" not in service.log.read_text()


def test_connections_without_a_request_delay_the_end_for_a_moment_only(start):
    service = start("--grace", str(PATIENCE))
    silent = service.connect()
    silent.connect()
    wait_for(lambda: b"reentry_connections 2" in service.get("/metrics").body)
    service.process.send_signal(signal.SIGTERM)
    assert service.process.wait(PATIENCE / 2) == 0
    silent.close()


def test_killed_under_load_it_starts_again_at_the_same_address(start):
    service = start()
    clients = [Client(service) for _ in range(CLIENTS)]
    for client in clients:
        client.start()
    wait_for(lambda: all(client.answered for client in clients))
    service.process.kill()
    service.process.wait()
    for client in clients:
        client.join(PATIENCE)
    again = start(port=service.port)
    assert again.port == service.port
    assert again.simulate(SHORT).status == 200


def test_two_services_cannot_have_one_address(start):
    service = start()
    result = run("serve", "--listen", "127.0.0.1:0", "--metrics-listen", f"127.0.0.1:{service.port}")
    assert result.returncode == 1
    assert f"cannot listen on 127.0.0.1:{service.port}" in result.stderr
    assert "panicked" not in result.stderr


def serving(port, **streams):
    """A service at a port whose standard streams are as given."""
    return subprocess.Popen([BINARY, "serve", "--listen", f"127.0.0.1:{port}"], env=clean_environment(), **streams)


@pytest.fixture
def port(tmp_path):
    """A port that was free a moment ago."""
    service = Service(tmp_path)
    service.end()
    return service.port


class Remote(Service):
    """A service that another has started."""

    def __init__(self, process, port):
        self.process, self.port = process, port

    def is_up(self):
        try:
            return self.get("/health/live").status == 200
        except OSError:
            assert self.process.poll() is None
            return False


def ends_well(process, port):
    """Whether it serves, and ends when told to."""
    try:
        remote = Remote(process, port)
        wait_for(remote.is_up)
        for _ in range(200):
            assert remote.simulate({**ORBIT, "stop": {"time": 1}}).status == 200
        process.send_signal(signal.SIGTERM)
        return process.wait(PATIENCE) == 0
    finally:
        process.kill()


def test_a_full_disk_under_the_log_has_no_effect(port):
    with open("/dev/full", "w") as full:
        assert ends_well(serving(port, stdout=full, stderr=full), port)


def test_closed_streams_have_no_effect(port):
    command = f"exec {BINARY} serve --listen 127.0.0.1:{port} <&- >&- 2>&-"
    process = subprocess.Popen(["sh", "-c", command], env=clean_environment())
    assert ends_well(process, port)


def test_a_log_that_nobody_reads_has_no_effect_but_lost_lines(port):
    read, write = os.pipe()
    process = serving(port, stderr=write)
    remote = Remote(process, port)
    wait_for(remote.is_up)
    connection = remote.connect()
    # The pipe and the lines that may wait are full long before.
    for _ in range(20_000):
        connection.request("GET", "/health/live")
        assert connection.getresponse().read() == b'{"status":"ok"}'
    wait_for(lambda: b"reentry_log_lines_lost_total 0\n" not in remote.get("/metrics").body)
    connection.close()
    os.close(read)
    os.close(write)
    process.send_signal(signal.SIGTERM)
    assert process.wait(PATIENCE) == 0


@pytest.mark.parametrize("command", [["simulate", "-"], ["openapi"], ["validate"], ["completions", "bash"]])
def test_a_full_disk_under_an_answer_is_told_and_ends_with_3(command):
    with open("/dev/full", "w") as full:
        result = subprocess.run(
            [BINARY, *command], input=json.dumps(SHORT), stdout=full, stderr=subprocess.PIPE, text=True, timeout=PATIENCE
        )
    assert result.returncode == 3
    assert "cannot write standard output: No space left on device" in result.stderr


def test_a_full_disk_under_standard_error_changes_no_answer():
    with open("/dev/full", "w") as full:
        result = subprocess.run(
            [BINARY, "simulate", "-"], input="[1]", stdout=subprocess.PIPE, stderr=full, text=True, timeout=PATIENCE
        )
    assert result.returncode == 1
    assert json.loads(result.stdout)["status"] == 422


@pytest.mark.parametrize(
    ("arguments", "environment", "named"),
    [
        (["--workers", "1025"], {}, "must be at most 1024"),
        (["--queue", "18446744073709551615"], {}, "must be at most"),
        (["--batches", "99999999"], {}, "must be at most"),
        (["--connections", "0"], {}, "must be at least 1"),
        (["--deadline", "1e300"], {}, "--deadline"),
        (["--deadline", "nan"], {}, "--deadline"),
        (["--memory", "1000"], {}, "--memory must be at least 67108864 bytes, 16 times --body-limit and 8 times --batch-body-limit, got 1000"),
        (["--rate-limit", "0"], {}, "from 0.001 to 1000000"),
        (["--rate-burst", "0"], {}, "--rate-burst"),
        (["--trusted-proxies", "10.0.0.0/33"], {}, "must be a network"),
        (["--forwarded-header", "x-real-ip"], {}, "x-forwarded-for"),
        (["--cors-origins", "https://a.example/"], {}, "must be a scheme and a host"),
        (["--cors-origins", "*,https://a.example"], {}, "must be a scheme and a host"),
        (["--cors-origins", "a.example"], {}, "must be a scheme and a host"),
        (["--listen", "127.0.0.1:8999", "--metrics-listen", "127.0.0.1:8999"], {}, "must differ from --listen"),
        (["--log", "=="], {}, "--log"),
        (["--log", "loud"], {}, "--log"),
        ([], {"RUST_LOG": "reentry=loud"}, "--log"),
        ([], {"REENTRY_CORS_ORIGINS": "all"}, "--cors-origins"),
        ([], {"REENTRY_RATE_LIMIT": "fast"}, "--rate-limit"),
    ],
)
def test_a_setting_that_cannot_be_is_named_and_ends_with_2(arguments, environment, named):
    result = run("serve", *arguments, **environment)
    assert result.returncode == 2, result.stderr
    assert named in result.stderr
    assert "panicked" not in result.stderr
