"""The program as its operator sees it: flags, exit codes and signals."""

import signal
import socket
from concurrent.futures import ThreadPoolExecutor

import pytest
from conftest import LONG, LONG_FLAGS, PATIENCE, run, wait_for


def test_the_help_names_the_variable_of_a_flag_and_its_default():
    result = run("serve", "--help")
    assert result.returncode == 0
    assert "[env: REENTRY_LISTEN=]" in result.stdout
    assert "[default: 127.0.0.1:8080]" in result.stdout


@pytest.mark.parametrize(
    ("arguments", "environment", "named"),
    [
        (["--deadline", "never"], {}, "--deadline"),
        (["--deadline", "0"], {}, "--deadline"),
        (["--queue", "-1"], {}, "-1"),
        (["--listen", "nowhere"], {}, "--listen"),
        (["--no-such-flag"], {}, "--no-such-flag"),
        ([], {"REENTRY_WORKERS": "many"}, "--workers"),
    ],
)
def test_a_bad_setting_is_named_and_ends_with_2(arguments, environment, named):
    result = run("serve", *arguments, **environment)
    assert result.returncode == 2
    assert named in result.stderr


def test_a_port_in_use_is_named_and_ends_with_1():
    with socket.create_server(("127.0.0.1", 0)) as taken:
        address = "127.0.0.1:{}".format(taken.getsockname()[1])
        result = run("serve", "--listen", address)
    assert result.returncode == 1
    assert f"cannot listen on {address}" in result.stderr
    assert "panicked" not in result.stderr


def test_a_port_from_the_environment_is_taken():
    with socket.create_server(("127.0.0.1", 0)) as taken:
        address = "127.0.0.1:{}".format(taken.getsockname()[1])
        assert address in run("serve", REENTRY_LISTEN=address).stderr


@pytest.mark.parametrize("stop", [signal.SIGTERM, signal.SIGINT])
def test_a_stop_signal_lets_a_running_request_finish_and_refuses_new_ones(start, stop):
    service = start("--workers", "1", "--queue", "0", *LONG_FLAGS)
    idle = service.connect()
    idle.request("GET", "/health/live")
    idle.getresponse().read()
    with ThreadPoolExecutor() as pool:
        running = pool.submit(service.simulate, LONG)
        service.wait_until_busy()
        service.process.send_signal(stop)
        wait_for(lambda: refuses(service))
        assert not running.done()
        answer = running.result()
    assert answer.status == 200
    assert len(answer.body) == int(answer.headers["content-length"])
    assert answer.body.endswith(b"}")
    # A connection that is open but has no request does not keep it.
    assert service.process.wait(PATIENCE) == 0


def refuses(service):
    try:
        with socket.create_connection(("127.0.0.1", service.port)):
            return False
    # A connection that was being made when the listener closed is reset.
    except (ConnectionRefusedError, ConnectionResetError):
        return True


def test_a_body_that_never_comes_keeps_the_service_for_its_grace_only(start):
    service = start("--grace", "0.1")
    head = "POST /simulate HTTP/1.1\r\nhost: x\r\ncontent-type: application/json\r\ncontent-length: 2\r\nexpect: 100-continue\r\n\r\n"
    with socket.create_connection(("127.0.0.1", service.port), PATIENCE) as client:
        client.sendall(head.encode())
        # From now on the request is being handled.
        assert client.recv(1000).startswith(b"HTTP/1.1 100")
        service.process.send_signal(signal.SIGTERM)
        assert service.process.wait(PATIENCE) == 0
    assert "still running at the end of the grace period" in service.log.read_text()
