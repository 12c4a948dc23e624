"""Runs the program itself, on real sockets."""

import http.client
import json
import os
import re
import signal
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path

import pytest

# As an absolute path: some tests run it in a folder of their own.
BINARY = os.path.abspath(os.environ.get("REENTRY", Path(__file__).parents[2] / "target/release/reentry"))
# How long a thing may take before it counts as never, s: the machine may be busy.
PATIENCE = 60.0

# An orbit, integrated as finely as the service allows: some 100 000 steps, a good part of a second.
ORBIT = {
    "angle_unit": "deg",
    "vehicle": {"mass": 1000, "reference_area": 1, "aerodynamics": {"type": "constant", "drag_coefficient": 0}},
    "initial_state": {
        "type": "planet_relative",
        "altitude": 400000,
        "longitude": 0,
        "geocentric_latitude": 10,
        "speed": 7600,
        "flight_path_angle": 0,
        "heading": 60,
    },
    "stop": {"time": 4.7e6},
    "solver": {"formulation": "spherical", "relative_tolerance": 1e-14},
    "output": {"trajectory": False},
}
# The same with a million rows: seconds. It needs the flags.
LONG = {**ORBIT, "output": {"count": 1_000_000}}
LONG_FLAGS = ("--row-limit", "1000000", "--memory", str(2 << 30), "--deadline", "60", "--grace", "60")


@dataclass
class Answer:
    """What came back."""

    status: int
    headers: http.client.HTTPMessage
    body: bytes

    def problem(self):
        """The problem document."""
        assert self.headers["content-type"] == "application/problem+json", self.headers
        problem = json.loads(self.body)
        assert problem["status"] == self.status
        return problem


def run(*arguments, **environment):
    """A run of the program that is to end by itself."""
    return subprocess.run(
        [BINARY, *arguments], env=clean_environment(**environment), capture_output=True, text=True, timeout=PATIENCE
    )


def clean_environment(**more):
    """The environment without settings for the service."""
    ours = {name: value for name, value in os.environ.items() if not name.startswith("REENTRY") and name != "RUST_LOG"}
    return {**ours, **more}


def wait_for(condition):
    """Waits until the condition holds, and returns its value."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        if value := condition():
            return value
        time.sleep(0.01)
    raise AssertionError("waited in vain")


class Service:
    """A running `reentry serve`."""

    def __init__(self, directory, *flags, port=0):
        self.log = directory / "stderr"
        with self.log.open("w") as log:
            self.process = subprocess.Popen(
                [BINARY, "serve", "--listen", f"127.0.0.1:{port}", *flags], env=clean_environment(), stderr=log
            )
        self.port = wait_for(self._port)
        self.url = f"http://127.0.0.1:{self.port}"

    def _port(self):
        assert self.process.poll() is None, self.log.read_text()
        line = re.search(r"listening on http://127\.0\.0\.1:(\d+)\n", self.log.read_text())
        return line and int(line[1])

    def connect(self):
        """A connection of its own."""
        return http.client.HTTPConnection("127.0.0.1", self.port, timeout=PATIENCE)

    def request(self, method, path, body=None, headers=None, **more):
        """Sends a request and reads the answer to its end."""
        connection = self.connect()
        try:
            connection.request(method, path, body, headers or {}, **more)
            response = connection.getresponse()
            return Answer(response.status, response.headers, response.read())
        finally:
            connection.close()

    def get(self, path, headers=None):
        """GET."""
        return self.request("GET", path, headers=headers)

    def simulate(self, case):
        """POST /simulate."""
        return self.request("POST", "/simulate", json.dumps(case), {"content-type": "application/json"})

    def is_ready(self):
        """Whether it says that it takes new work."""
        return self.get("/health/ready").status == 200

    def wait_until_busy(self):
        """Waits until there is no place for one more request."""
        wait_for(lambda: not self.is_ready())

    def cpu_seconds(self):
        """The processor time that it has used."""
        stat = Path(f"/proc/{self.process.pid}/stat").read_text()
        user, system = stat.rpartition(")")[2].split()[11:13]
        return (int(user) + int(system)) / os.sysconf("SC_CLK_TCK")

    def wait_until_idle(self):
        """Waits until it uses no processor time any more."""

        def idle():
            before = self.cpu_seconds()
            time.sleep(0.5)
            return self.cpu_seconds() == before

        wait_for(idle)

    def end(self):
        """Ends it, if it still runs; the log is shown with a test that fails."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGKILL)
        self.process.wait()
        print(self.log.read_text()[-2000:])


@pytest.fixture
def start(tmp_path_factory):
    """Starts services with flags; they end with the test."""
    services = []

    def start(*flags, port=0):
        services.append(Service(tmp_path_factory.mktemp("service"), *flags, port=port))
        return services[-1]

    yield start
    for service in services:
        service.end()


@pytest.fixture(scope="module")
def service(tmp_path_factory):
    """A service with its default settings."""
    service = Service(tmp_path_factory.mktemp("service"))
    yield service
    service.end()


@pytest.fixture
def file(tmp_path):
    """Writes a value to a file."""

    def file(value, name="case.json"):
        path = tmp_path / name
        path.write_text(value if isinstance(value, str) else json.dumps(value))
        return str(path)

    return file
