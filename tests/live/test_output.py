"""What the commands write: answers whose memory is bounded, lines that are safe to read, files that are whole."""

import json
import os
import resource
import signal
import stat
import subprocess
import threading
import time
import unicodedata
from pathlib import Path

import pytest
from conftest import BINARY, LONG, ORBIT, PATIENCE, clean_environment, run, wait_for

EXAMPLES = Path(__file__).parents[2] / "openapi/examples"
TARGET = str(EXAMPLES / "target_1.json")
CASE = json.loads(Path(TARGET).read_text())
# What moves the cursor, changes colours, begins a line, hides or turns text: ESC, CR, LF, BEL, DEL, CSI of C1, line separator,
# overrides and isolates of the direction, zero width, soft hyphen.
FORGERY = "\x1b[2J\r\n\x07\x7f\x9b31m\u2028\u2029\u202e\u2066\u200b\u00ad\ufeff"
MEBIBYTE = 1 << 20


def is_safe(text):
    """Whether a text has lines of visible characters alone."""
    return all(line.isprintable() and not any(unicodedata.category(c) == "Cf" for c in line) for line in text.split("\n"))


def resident(process):
    """The greatest memory that a process has had, bytes."""
    status = Path(f"/proc/{process.pid}/status").read_text()
    return int(status.split("VmHWM:")[1].split()[0]) * 1024


def cpu(process):
    """The processor time of a process, in ticks."""
    return sum(map(int, Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()[11:13]))


def wait_until_at_rest(process):
    """Waits until a process has worked, and does so no more."""
    time.sleep(1)

    def rests():
        before = cpu(process)
        time.sleep(1)
        return cpu(process) == before

    wait_for(rests)


def test_a_stalled_reader_bounds_what_is_computed_ahead(file):
    rows = 100_000
    path = file([{**CASE, "output": {"count": rows}}] * 60)
    alone = run("simulate", file({**CASE, "output": {"count": rows}}, "one.json")).stdout
    with subprocess.Popen([BINARY, "simulate", path], stdout=subprocess.PIPE, env=clean_environment()) as process:
        assert process.stdout.read(1) == b"{"
        wait_until_at_rest(process)
        # What may wait, an answer of each thread beyond it, one that is being written; and as rows and text what each thread worked on.
        threads = len(os.sched_getaffinity(0))
        bound = 64 * MEBIBYTE + (threads + 1) * len(alone) + threads * rows * 1024 + 32 * MEBIBYTE
        most = resident(process)
        print(f"{most / MEBIBYTE:.0f} MiB of {bound / MEBIBYTE:.0f} MiB; an answer has {len(alone) / MEBIBYTE:.0f} MiB")
        assert most < bound
        # Whoever reads on gets on: as much again as may wait.
        assert sum(process.stdout.readline().endswith(b"}\n") for _ in range(6)) == 6
        process.kill()


@pytest.mark.parametrize("limit", ["18446744073709551615", "18446744073709551616", "10000001"])
def test_the_limit_of_rows_has_a_limit(limit):
    result = run("simulate", TARGET, "--row-limit", limit)
    assert (result.returncode, result.stdout) == (2, "")
    assert f"invalid value '{limit}' for '--row-limit <ROW_LIMIT>': must be at most 10000000" in result.stderr


def test_a_limit_of_rows_within_it_is_one():
    assert run("simulate", TARGET, "--row-limit", "10000000").returncode == 0
    assert run("simulate", TARGET, "--row-limit", "many").returncode == 2


def test_rows_for_which_there_is_no_memory_are_refused(file):
    """As where a container has less: the system then kills the program; here it refuses the memory."""

    def with_little():
        resource.setrlimit(resource.RLIMIT_AS, (1 << 30, 1 << 30))

    path = file({**CASE, "output": {"count": 10_000_000}})
    command = [BINARY, "simulate", path, "--row-limit", "10000000"]
    result = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE, preexec_fn=with_little, env=clean_environment())
    assert (result.returncode, result.stdout) == (1, "")
    assert "Too many rows: the trajectory has 10000000 rows, too many for the available memory\n" in result.stderr
    assert "  /output: gives 10000000 rows, too many for the available memory" in result.stderr


@pytest.mark.parametrize(
    "case",
    [
        {**CASE, FORGERY: 1},
        {**CASE, "vehicle": {**CASE["vehicle"], f"mass{FORGERY}": 1}},
        {**CASE, "angle_unit": FORGERY},
        {**CASE, "name": FORGERY, "angle_unit": FORGERY},
        {**CASE, "epoch": FORGERY},
        {**CASE, "output": {"columns": [FORGERY]}},
        {**CASE, "events": [{"when": {"event": FORGERY}, "then": {"mass": 1}}]},
        f'{{"{FORGERY[-6:]}": 1, "{FORGERY[-6:]}": 2}}',
    ],
)
def test_no_name_reaches_the_terminal_as_it_is(file, case):
    for value in [case, f"[{case}]" if isinstance(case, str) else [case]]:
        result = run("simulate", path := file(value))
        assert result.returncode == 1
        assert is_safe(result.stderr), result.stderr
        assert all(line.startswith((f"reentry: {path}: ", "  ")) for line in result.stderr.splitlines())
        assert "\\u{" in result.stderr


def test_no_path_or_argument_reaches_the_terminal_as_it_is(tmp_path):
    evil = FORGERY.replace("/", "")
    (tmp_path / evil).write_text("5")
    for arguments in [
        ["simulate", str(tmp_path / evil)],
        ["simulate", f"/no/such/{evil}"],
        ["simulate", TARGET, "-o", f"/no/such/{evil}"],
        [evil],
        [f"simulate{evil}"],
        ["simulate", f"--{evil}"],
        ["simulate", TARGET, f"--row-limit{evil}", "1"],
        ["simulate", TARGET, "--format", evil],
        ["simulate", TARGET, "--row-limit", evil],
        ["simulate", TARGET, evil],
        ["serve", "--cors-origins", evil],
        ["serve", "--log", f"reentry=x{evil}"],
        ["healthcheck", "--listen", evil],
    ]:
        result = run(*arguments)
        assert result.returncode in (1, 2, 3), arguments
        assert is_safe(result.stderr), (arguments, result.stderr)
        assert "\\u{1b}" in result.stderr, arguments
        assert result.stdout == ""
    result = run("serve", REENTRY_LISTEN=evil)
    assert result.returncode == 2
    assert is_safe(result.stderr), result.stderr


def test_wrong_elements_are_told_up_to_a_count(file):
    many = 300_000
    result = run("simulate", path := file("[" + ",".join(["1"] * many) + "]"))
    assert result.returncode == 1
    # Every case has its line on standard output, where programs read.
    assert result.stdout.count("\n") == many
    lines = result.stderr.splitlines()
    assert len(lines) == 201
    assert lines[-1] == f"reentry: {path}: {many - 100} more cases failed"


def test_faults_are_told_up_to_a_count(file):
    times = {**CASE, "output": {"times": [""] * 1_000_000}}
    for value, most in [(times, 102), ([times], 12)]:
        result = run("simulate", file(value))
        assert result.returncode == 1
        lines = result.stderr.splitlines()
        assert lines[0].endswith("Case not valid: more than 100 problems in the request")
        assert lines[1] == "  /output/times/0: must be a number, got a string"
        assert len(lines) == most
        assert lines[-1] == ("  more than 100 problems; the others are not listed" if most == 102 else "  more problems; run the case alone to list them all")


def test_a_name_of_a_mebibyte_is_shortened_for_people_alone(file):
    name = "x" * MEBIBYTE
    result = run("simulate", file([{**CASE, "name": name, name: 1, "angle_unit": name}]))
    assert result.returncode == 1
    assert len(result.stderr) < 4096
    assert json.loads(result.stdout)["errors"][1]["pointer"] == f"/{name}"


def test_faults_take_no_more_memory_than_what_they_are_about(file):
    """Once, a string was made for each of them."""

    def most(value):
        process = subprocess.Popen([BINARY, "simulate", file(value)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        return process.returncode, usage.ru_maxrss * 1024

    numbers = [0.5 + index for index in range(2_000_000)]
    sound, sound_bytes = most({**CASE, "output": {"times": numbers}})
    wrong, wrong_bytes = most({**CASE, "output": {"times": [-1e300] * 2_000_000}})
    assert (sound, wrong) == (0, 1)
    assert wrong_bytes < sound_bytes + 16 * MEBIBYTE


def test_a_file_is_whole_or_as_it_was(file, tmp_path):
    folder = tmp_path / "out"
    folder.mkdir()
    output = folder / "answers.ndjson"
    output.write_text("older")
    output.chmod(0o640)
    path = file([CASE] * 20 + [LONG] * 20)
    for number in [signal.SIGINT, signal.SIGTERM]:
        with subprocess.Popen([BINARY, "simulate", path, "-o", str(output)], env=clean_environment()) as process:
            wait_for(lambda: any(part.stat().st_size for part in folder.glob(".reentry-*.part")))
            assert output.read_text() == "older"
            process.send_signal(number)
            assert process.wait(PATIENCE) == -number
        assert output.read_text() == "older"
        assert list(folder.iterdir()) == [output]
    assert run("simulate", file([CASE] * 3), "-o", str(output)).returncode == 0
    assert output.read_text().count("\n") == 3
    assert stat.S_IMODE(output.stat().st_mode) == 0o640
    assert list(folder.iterdir()) == [output]


def test_a_full_disk_leaves_the_older_file(file, tmp_path):
    output = tmp_path / "out.csv"
    output.write_text("older")

    def with_little():
        # Writing further fails then, as on a full disk.
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (65536, 65536))

    command = [BINARY, "simulate", file([CASE] * 100), "-f", "csv", "-o", str(output)]
    result = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE, preexec_fn=with_little, env=clean_environment())
    assert result.returncode == 3
    assert result.stderr == f"reentry: cannot write {output}: File too large (os error 27)\n"
    assert output.read_text() == "older"
    assert not list(tmp_path.glob(".reentry*"))


def test_a_new_file_has_the_permissions_of_the_mask(tmp_path):
    output = tmp_path / "new.json"
    subprocess.run([BINARY, "simulate", TARGET, "-o", str(output)], check=True, umask=0o027, env=clean_environment())
    assert stat.S_IMODE(output.stat().st_mode) == 0o640
    # In the folder where one is.
    subprocess.run([BINARY, "simulate", TARGET, "-o", "here.json"], check=True, cwd=tmp_path, env=clean_environment())
    assert json.loads((tmp_path / "here.json").read_text())


def test_a_link_stays_a_link(tmp_path):
    target, link, loose = tmp_path / "target.json", tmp_path / "link.json", tmp_path / "loose.json"
    target.write_text("older")
    link.symlink_to("target.json")
    loose.symlink_to("later.json")
    for output in [link, loose]:
        assert run("simulate", TARGET, "-o", str(output)).returncode == 0
        assert output.is_symlink()
        assert json.loads(output.read_text())["name"] == CASE["name"]
    assert json.loads(target.read_text())


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write what it likes")
def test_a_file_that_may_not_be_written_is_not_replaced(tmp_path):
    output = tmp_path / "theirs.json"
    output.write_text("older")
    output.chmod(0o444)
    assert run("simulate", TARGET, "-o", str(output)).returncode == 3
    assert output.read_text() == "older"


def test_what_is_no_file_is_written_as_it_is(tmp_path):
    assert run("simulate", TARGET, "-o", "/dev/null").returncode == 0
    assert stat.S_ISCHR(os.stat("/dev/null").st_mode)
    expected = run("simulate", TARGET, "-f", "csv").stdout
    assert run("simulate", TARGET, "-f", "csv", "-o", "/dev/stdout").stdout == expected
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    read = []
    reader = threading.Thread(target=lambda: read.append(pipe.read_text()))
    reader.start()
    assert run("simulate", TARGET, "-f", "csv", "-o", str(pipe)).returncode == 0
    reader.join(PATIENCE)
    assert read == [expected]
    assert stat.S_ISFIFO(pipe.stat().st_mode)
    # A file that somebody has opened to write at its end.
    log = tmp_path / "log"
    log.write_text("older\n")
    with log.open("a") as end:
        subprocess.run([BINARY, "simulate", TARGET, "-f", "csv", "-o", "/dev/stdout"], stdout=end, check=True, env=clean_environment())
    assert log.read_text() == "older\n" + expected


@pytest.mark.parametrize("command", [["simulate", TARGET], ["simulate", TARGET, "-f", "csv"], ["validate"], ["openapi"], ["completions", "bash"]])
def test_a_closed_standard_output_is_an_error(command):
    def ended(closing):
        result = subprocess.run(["sh", "-c", f'"$@" {closing}', "sh", BINARY, *command], capture_output=True, text=True, env=clean_environment())
        return result.returncode, result.stderr

    assert ended(">&-") == (3, "reentry: cannot write standard output: it is closed\n")
    assert ended(">&- 2>&-") == (3, "")
    assert ended("<&- >&-") == (3, "reentry: cannot write standard output: it is closed\n")
    assert ended("1< /dev/null")[0] == 3
    assert ended(">/dev/full") == (3, "reentry: cannot write standard output: No space left on device (os error 28)\n")
    # Whoever wants no output gets none, however it is opened.
    assert ended(">/dev/null") == ended("1<>/dev/null") == ended("2>&-") == ended("<&-") == (0, "")
    assert subprocess.run([BINARY, *command], stdout=subprocess.DEVNULL, env=clean_environment()).returncode == 0


def test_a_closed_standard_output_is_none_where_the_answer_goes_elsewhere(tmp_path):
    output = tmp_path / "out.json"
    command = ["sh", "-c", '"$@" >&-', "sh", BINARY, "simulate", TARGET, "-o", str(output)]
    assert subprocess.run(command, env=clean_environment()).returncode == 0
    assert json.loads(output.read_text())["name"] == CASE["name"]
