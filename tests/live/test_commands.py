"""The commands that need no service: files in, answers out, and the codes with which they end."""

import contextlib
import csv
import datetime
import io
import json
import os
import pty
import re
import signal
import socket
import subprocess
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import jsonschema
import pytest
from conftest import BINARY, LONG, ORBIT, PATIENCE, clean_environment, run, wait_for

EXAMPLES = Path(__file__).parents[2] / "openapi/examples"
TARGET = str(EXAMPLES / "target_1.json")
STATE = str(EXAMPLES / "impulse_state.json")
CASE = json.loads(Path(TARGET).read_text())
BAD = {**CASE, "name": 'a "bad"\none', "vehicle": {**CASE["vehicle"], "mass": -1}, "colour": "red"}
MASS = "  /vehicle/mass: must be greater than 0, got -1\n"


def reproducible(answer):
    """An answer but for the one thing that differs from run to run."""
    return {**answer, "solver": {**answer["solver"], "elapsed": None}} if "solver" in answer else answer


def post(service, path, text):
    return service.request("POST", path, text, {"content-type": "application/json"}).body


def test_the_answer_is_that_of_the_service(service):
    text = Path(TARGET).read_text()
    assert reproducible(json.loads(run("simulate", TARGET).stdout)) == reproducible(json.loads(post(service, "/simulate", text)))
    assert run("simulate", TARGET, "--format", "csv").stdout.encode() == post(service, "/simulate?format=csv", text)
    assert run("convert", STATE).stdout.encode() == post(service, "/convert", Path(STATE).read_text()) + b"\n"


def test_indices_of_space_weather_come_from_a_file(tmp_path):
    days = [datetime.date(2026, 1, 1) + datetime.timedelta(day) for day in range(100)]
    rows = [f"{day:%Y %m %d} 0 0.5 2626 4 {'2.0 ' * 8}{'7 ' * 8}7 58 120.0 999.0 1" for day in days]
    file = tmp_path / "indices.txt"
    file.write_text("\n".join(["# as the GFZ writes them", *rows]) + "\n")
    case = {**CASE, "epoch": "2026-02-20T12:00:00Z", "atmosphere": {"type": "nrlmsise00", "indices": "file"}}
    cases = tmp_path / "case.json"
    cases.write_text(json.dumps(case))
    flown = json.loads(run("simulate", str(cases), "--space-weather", str(file)).stdout)
    taken = {"f107": 120.0, "f107_average": 120.0, "ap": 7.0, "ap_history": [7.0] * 7}
    assert flown["models"]["space_weather"] == taken
    assert "without --space-weather" in run("simulate", str(cases)).stderr
    cases.write_text(json.dumps({**case, "epoch": "2026-01-15T12:00:00Z"}))
    early = run("--space-weather", str(file), "simulate", str(cases))
    assert early.returncode == 1
    assert "/atmosphere/indices" in early.stderr
    assert "2026-01-01 to 2026-04-10" in early.stderr
    file.write_text("nonsense\n")
    assert run("--space-weather", str(file), "planets").returncode == 2
    assert run("--space-weather", str(tmp_path / "none.txt"), "planets").returncode == 3
    assert len(json.loads(run("planets").stdout)["planets"]) == 11


def test_a_state_is_json_and_no_table():
    assert run("convert", STATE, "--format", "json").stdout == run("convert", STATE).stdout
    refused = run("convert", STATE, "--format", "csv")
    assert (refused.returncode, refused.stdout) == (2, "")
    assert "possible values: json" in refused.stderr


def test_a_minus_is_standard_input():
    result = subprocess.run(
        [BINARY, "simulate", "-", "-f", "csv"], input=Path(TARGET).read_bytes(), capture_output=True, timeout=PATIENCE
    )
    assert result.returncode == 0
    assert result.stderr == b""
    assert result.stdout.decode() == run("simulate", TARGET, "-f", "csv").stdout


def test_a_case_that_is_not_valid_is_told_and_ends_with_1(file):
    result = run("simulate", path := file(BAD))
    assert result.returncode == 1
    assert result.stdout == ""
    lines = result.stderr.splitlines(keepends=True)
    assert lines[0] == f"reentry: {path}: Case not valid: 2 problems in the request\n"
    assert lines[1] == MASS
    assert lines[2].startswith("  /colour: is not a field here")
    assert len(lines) == 3


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ('{"vehicle": }', "Not JSON: the body is not JSON: expected value at line 1 column 13\n"),
        ("[1,", "Not JSON: the body is not JSON: EOF while parsing a value at line 1 column 3\n"),
        ("5", "Case not valid: 1 problem in the request\n  must be an object, got a number\n"),
        (json.dumps({**CASE, "output": {"count": 1_000_001}}), "Too many rows: the trajectory exceeds the limit of 1000000 rows"),
        (json.dumps({**ORBIT, "stop": {"time": 1e9}}), "Too many steps: the flight cannot be completed"),
    ],
)
def test_every_failure_of_a_case_ends_with_1(file, text, told):
    result = run("simulate", path := file(text))
    assert result.returncode == 1
    assert result.stdout == ""
    assert result.stderr.startswith(f"reentry: {path}: {told}")


def test_the_limit_of_rows_is_a_flag():
    assert run("simulate", TARGET, "--row-limit", "25").returncode == 0
    assert run("simulate", TARGET, "--row-limit", "24").returncode == 1


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["simulate", "/no/such.json"], "cannot read /no/such.json: No such file"),
        (["simulate", "/"], "cannot read /: Is a directory"),
        (["simulate", TARGET, "-o", "/no/such/file"], "cannot write /no/such/file: No such file"),
        (["simulate", TARGET, "-o", "/dev/full"], "cannot write /dev/full: No space left"),
        (["convert", "/no/such.json"], "cannot read /no/such.json: No such file"),
    ],
)
def test_a_file_that_cannot_be_read_or_written_ends_with_3(arguments, told):
    result = run(*arguments)
    assert result.returncode == 3
    assert result.stderr.startswith(f"reentry: {told}")
    assert result.stdout == ""


@pytest.mark.parametrize(
    "arguments", [[], ["frobnicate"], ["simulate"], ["validate", "-f", "csv"], ["simulate", TARGET, "-f", "ndjson"], ["convert", STATE, "-f", "csv"], ["completions", "x"]]
)
def test_a_wrong_command_line_ends_with_2(arguments):
    result = run(*arguments)
    assert result.returncode == 2
    assert "--help" in result.stderr
    assert result.stdout == ""


def test_an_output_file_is_written_if_there_is_something_to_write(file, tmp_path):
    output = tmp_path / "out.csv"
    result = run("simulate", TARGET, "--format", "csv", "--output", str(output))
    assert (result.returncode, result.stdout, result.stderr) == (0, "", "")
    written = output.read_text()
    assert written == run("simulate", TARGET, "--format", "csv").stdout
    assert run("simulate", file(BAD), "-o", str(output)).returncode == 1
    assert output.read_text() == written


def test_a_list_of_cases_has_a_line_each_in_order(service, file):
    # The first takes longest: order is no accident.
    cases = [ORBIT, CASE, BAD, 5, *({**CASE, "name": str(index)} for index in range(200))]
    result = run("simulate", path := file(cases))
    assert result.returncode == 1
    lines = result.stdout.splitlines()
    batch = post(service, "/simulate/batch", json.dumps(cases)).splitlines()
    assert len(lines) == len(batch) == len(cases)
    for line, answer in zip(lines, batch):
        assert reproducible(json.loads(line)) == reproducible(json.loads(answer))
    told = result.stderr.splitlines(keepends=True)
    assert told[0] == rf'reentry: {path}: case 2 "a \"bad\"\none": Case not valid: 2 problems in the request' + "\n"
    assert told[1] == MASS
    assert told[3] == f"reentry: {path}: case 3: Case not valid: 1 problem in the request\n"
    assert len(told) == 5


def test_a_list_of_good_cases_ends_with_0(file):
    result = run("simulate", file([CASE, CASE]))
    assert (result.returncode, result.stderr) == (0, "")
    assert len(result.stdout.splitlines()) == 2
    states = run("convert", file([json.loads(Path(STATE).read_text())] * 3))
    assert states.returncode == 0
    assert states.stdout == run("convert", STATE).stdout * 3


def test_an_empty_list_is_a_fault_as_it_is_in_a_batch(file):
    result = run("simulate", path := file([]))
    assert (result.returncode, result.stdout) == (1, "")
    assert result.stderr == f"reentry: {path}: Case not valid: 1 problem in the request\n  must have at least 1 case, got none\n"


def test_the_place_of_a_fault_of_json_is_that_in_the_case(file):
    result = run("simulate", path := file(f'[{json.dumps(CASE)},\n\n{{"name": "a", "name": "b"}}]'))
    assert result.returncode == 1
    fault = 'Not JSON: the case is not JSON: duplicate key "name" at line 1 column 20 of the case'
    assert result.stderr == f"reentry: {path}: case 1: {fault}\n"


def test_a_theory_is_set_beside_a_flight(service):
    case = str(EXAMPLES / "steep_ballistic.json")
    text = Path(case).read_text()
    assert run("analytic", case).stdout.encode() == post(service, "/analytic", text) + b"\n"
    assert run("analytic", case, "-f", "csv").stdout.encode() == post(service, "/analytic?format=csv", text)
    result = run("analytic", TARGET)
    assert result.returncode == 1
    assert "/solution: is required" in result.stderr


def test_a_list_as_csv_is_one_table_with_the_number_of_the_case(file):
    result = run("simulate", file([BAD, CASE, BAD, CASE]), "--format", "csv")
    assert result.returncode == 1
    rows = list(csv.reader(io.StringIO(result.stdout)))
    single = list(csv.reader(io.StringIO(run("simulate", TARGET, "--format", "csv").stdout)))
    assert rows[0] == ["case", *single[0]]
    assert rows[1:] == [[case, *row] for case in "13" for row in single[1:]]


def test_a_list_of_cases_with_events_has_their_columns_and_a_case_without_them_fails_alone(file):
    eventful = json.loads((EXAMPLES / "deorbit.json").read_text())
    lines = [json.loads(line) for line in run("simulate", file([eventful, CASE])).stdout.splitlines()]
    assert [event["name"] for event in lines[0]["events"]] == [event["name"] for event in eventful["events"]]
    assert "events" not in lines[1]
    result = run("simulate", path := file([eventful, CASE, eventful]), "--format", "csv")
    assert result.returncode == 1
    assert result.stderr.startswith(f'reentry: {path}: case 1 "TARGET reference case 1": Case not valid: 1 problem in the request\n  /output/columns: ')
    rows = list(csv.reader(io.StringIO(result.stdout)))
    assert rows[0][0] == "case"
    assert rows[0][-5:] == ["heat_load", "wall_temperature", "mass", "ground_range", "ground_distance"]
    masses = [float(row[-3]) for row in rows[1:] if row[0] == "2"]
    assert {row[0] for row in rows[1:]} == {"0", "2"}
    assert (masses[0], masses[-1]) == (7000.0, 2700.0)


@pytest.mark.parametrize("command", [["simulate"], ["simulate", "-f", "csv"], ["validate"], ["openapi"], ["completions", "bash"]])
def test_a_reader_that_has_enough_is_no_failure(file, command):
    # More than a pipe holds.
    arguments = [*command, file([CASE] * 300)] if command[0] == "simulate" else command
    with subprocess.Popen([BINARY, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=clean_environment()) as process:
        assert process.stdout.readline()
        process.stdout.close()
        assert process.stderr.read() == b""
        assert process.wait(PATIENCE) == 0


def test_nobody_who_reads_the_errors_is_no_panic(file):
    reader, writer = os.pipe()
    os.close(reader)
    result = subprocess.run([BINARY, "simulate", file(BAD)], stdout=subprocess.PIPE, stderr=writer, timeout=PATIENCE)
    os.close(writer)
    assert result.returncode == 1


def test_an_interrupt_ends_it_at_once(file):
    path = file([LONG] * 100)
    with subprocess.Popen([BINARY, "simulate", path], stdout=subprocess.DEVNULL, env=clean_environment()) as process:
        wait_for(lambda: len(list(Path(f"/proc/{process.pid}/task").iterdir())) > 1)
        process.send_signal(signal.SIGINT)
        assert process.wait(PATIENCE) == -signal.SIGINT


def on_a_terminal(*arguments, stdout):
    """What the program writes on standard error, a terminal."""
    terminal, inside = pty.openpty()
    with subprocess.Popen([BINARY, *arguments], stdout=stdout or inside, stderr=inside, env=clean_environment(TERM="xterm")) as process:
        os.close(inside)
        text = b""
        while True:
            try:
                text += os.read(terminal, 65536)
            except OSError:
                break
        process.wait(PATIENCE)
    os.close(terminal)
    return text.decode()


def test_a_terminal_sees_how_far_it_is(file):
    path = file([ORBIT] * 4 + [BAD])
    text = on_a_terminal("simulate", path, stdout=subprocess.DEVNULL)
    assert re.search(r"[0-5] of 5 cases", text), text
    assert "case 4" in text
    assert "of 5 cases" not in run("simulate", path).stderr
    # Where the answers come to the same terminal, they are what shows how far it is.
    assert "of 5 cases" not in on_a_terminal("simulate", path, stdout=None)
    assert "cases" not in on_a_terminal("simulate", TARGET, stdout=subprocess.DEVNULL)


def test_a_terminal_sees_how_many_flights_a_search_has_flown():
    corridor = str(EXAMPLES / "corridor.json")
    assert re.search(r"[1-9][0-9]* flights, ", on_a_terminal("corridor", corridor, stdout=subprocess.DEVNULL))
    assert run("corridor", corridor).stderr == ""


def test_the_health_of_a_service_is_asked(start):
    service = start("--workers", "1", "--queue", "0", "--deadline", "60")
    # Every address: 127.0.0.1 among them.
    assert run("healthcheck", REENTRY_LISTEN=f"0.0.0.0:{service.port}").returncode == 0
    result = run("healthcheck", "--ready", "--listen", f"127.0.0.1:{service.port}")
    assert (result.returncode, result.stdout, result.stderr) == (0, "ok\n", "")
    connection = service.connect()
    connection.request("POST", "/simulate", json.dumps(LONG | {"output": {"count": 100_000}}), {"content-type": "application/json"})
    service.wait_until_busy()
    busy = run("healthcheck", "--ready", REENTRY_LISTEN=f"0.0.0.0:{service.port}")
    live = run("healthcheck", REENTRY_LISTEN=f"0.0.0.0:{service.port}")
    connection.close()
    service.end()
    assert live.returncode == 0
    assert busy.returncode == 1
    assert "503" in busy.stderr
    gone = run("healthcheck", REENTRY_LISTEN=f"0.0.0.0:{service.port}")
    assert gone.returncode == 1
    assert f"http://127.0.0.1:{service.port}/health/live does not answer" in gone.stderr


def test_a_service_that_talks_for_ever_has_no_health():
    """Nor does one that says nothing; a good status line is enough, whatever follows."""

    def asked(say):
        with socket.create_server(("127.0.0.1", 0)) as server, ThreadPoolExecutor() as pool:
            said = pool.submit(say, server)
            result = run("healthcheck", "--listen", f"127.0.0.1:{server.getsockname()[1]}")
            said.result()
            return result

    def drip(server):
        client, _ = server.accept()
        with client, contextlib.suppress(OSError):
            while True:
                client.sendall(b"H")
                time.sleep(0.1)

    def hold(server):
        client, _ = server.accept()
        with client:
            client.sendall(b"HTTP/1.1 200 OK\r\n")
            # Until the other side has gone.
            while client.recv(1024):
                pass

    slow = asked(drip)
    assert slow.returncode == 1
    assert "no answer within 2 s" in slow.stderr
    assert asked(hold).returncode == 0


def test_without_lanes_a_search_has_the_same_answer():
    def answer(*arguments, **environment):
        found = run("corridor", "openapi/examples/corridor.json", *arguments, **environment)
        assert found.returncode == 0, found.stderr
        return re.sub(r'"elapsed": ?[0-9.e-]+', "", found.stdout)

    together = answer()
    assert answer("--lanes", "0") == together
    assert answer(REENTRY_LANES="0") == together
    assert run("--version", REENTRY_LANES="0").stdout.endswith("lanes: none\n")
    assert run("--lanes", "2", "planets").returncode == 2


def test_the_program_tells_its_version_its_codes_and_its_document(service):
    version = json.loads(run("openapi").stdout)["info"]["version"]
    assert run("-V").stdout == f"reentry {version}\n"
    first, lanes = run("--version").stdout.splitlines()
    assert first == f"reentry {version}"
    assert lanes in ("lanes: avx512", "lanes: avx2", "lanes: none")
    build = next(line for line in service.get("/metrics").body.decode().splitlines() if line.startswith("reentry_build_info{"))
    assert f'lanes="{lanes.removeprefix("lanes: ")}"' in build
    assert json.loads(run("openapi").stdout) == json.loads(service.get("/openapi.json").body)
    for arguments in [["--help"], ["simulate", "--help"], ["convert", "--help"], ["validate", "--help"]]:
        text = run(*arguments).stdout
        assert "Exit codes:\n  0  " in text
        assert "\n  3  a file cannot be read or written" in text


@pytest.mark.parametrize("command", ["simulate", "convert", "validate"])
def test_the_examples_of_the_help_can_be_pasted(command, tmp_path):
    # An OEM has dates.
    (tmp_path / "case.json").write_text(json.dumps({**CASE, "epoch": "2026-01-01T00:00:00Z"}))
    (tmp_path / "cases.json").write_text(json.dumps([CASE, CASE]))
    (tmp_path / "state.json").write_text(Path(STATE).read_text())
    text = run(command, "--help").stdout.split("Examples:\n")[1].split("\n\n")[0]
    script = re.sub(r"(?m)^  | \| jq \S+$", "", text)
    assert script.count("reentry " + command) >= 2
    environment = clean_environment(PATH=f"{Path(BINARY).resolve().parent}:{os.environ['PATH']}")
    result = subprocess.run(["bash", "-ec", script], cwd=tmp_path, env=environment, capture_output=True, timeout=PATIENCE)
    assert (result.returncode, result.stderr) == (0, b"")


def test_the_reference_cases_pass_and_are_told_as_text():
    result = run("validate")
    assert (result.returncode, result.stderr) == (0, "")
    assert "FAILED" not in result.stdout
    assert "checks against references: all passed." in result.stdout.splitlines()[-1]
    assert "Stardust" in result.stdout


def test_the_validation_is_that_of_the_service_and_fits_its_schema(service):
    result = run("validate", "--format", "json")
    assert (result.returncode, result.stderr) == (0, "")
    assert result.stdout.encode() == service.get("/validation").body + b"\n"
    validation = json.loads(result.stdout)
    document = json.loads(run("openapi").stdout)
    schema = {"$ref": "#/components/schemas/Validation", "components": document["components"]}
    jsonschema.Draft202012Validator(schema).validate(validation)
    assert validation["passed"]
    kinds = [check["kind"] for check in validation["checks"]]
    assert kinds.count("reference") > 100
    assert all(check["passed"] == (True if check["kind"] == "reference" else None) for check in validation["checks"])


def test_the_licences_are_those_of_the_service(service):
    for of_format in ("text", "json"):
        result = run("licences", "--format", of_format)
        assert (result.returncode, result.stderr) == (0, "")
        assert result.stdout.rstrip("\n").encode() == service.get(f"/licences?format={of_format}").body.rstrip(b"\n")
    assert run("licences").stdout.startswith("reentry ")


def test_the_guide_has_the_validation_as_it_is_shipped():
    result = run("validate", "--format", "markdown")
    assert result.returncode == 0
    assert result.stdout in (Path(__file__).parents[2] / "crates/service/guide/validation.md").read_text()


def test_bash_completes_the_commands(file):
    script = file(run("completions", "bash").stdout, "completions.bash")
    ask = f"source {script}; COMP_WORDS=(reentry sim); COMP_CWORD=1; _reentry reentry sim reentry; echo ${{COMPREPLY[@]}}"
    result = subprocess.run(["bash", "-c", ask], capture_output=True, text=True, timeout=PATIENCE)
    assert result.stdout == "simulate\n", result.stderr
    for shell in ["zsh", "fish", "elvish", "powershell"]:
        assert "simulate" in run("completions", shell).stdout
