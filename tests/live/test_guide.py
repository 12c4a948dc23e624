"""The README and the guide: every block of shell and Python runs as a reader would run it, and prints the output shown below it."""

import json
import math
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import BINARY

ROOT = Path(__file__).parents[2]
DOCUMENTS = [ROOT / "README.md", *sorted((ROOT / "crates/service/guide").glob("*.md"))]
FENCE = re.compile(r"^(?P<indent> *)```(?P<info>[^\n]*)\n(?P<text>.*?)^(?P=indent)```$", re.DOTALL | re.MULTILINE)
RUN = {"sh": ["bash", "-euo", "pipefail", "-c"], "python": [sys.executable, "-c"]}
# Blocks that are not run: answers and fragments of cases, commands that install or need Docker, other languages.
OTHER = {"json", "text", "console", "python client", "ts", "rust", "yaml", "html", "json case"}


def blocks(document):
    """The fenced blocks with their lines, each with what stands between it and the block before."""
    text, end = document.read_text(), 0
    for match in FENCE.finditer(text):
        yield match["info"].strip(), match["text"], text[end : match.start()], text.count("\n", 0, match.start()) + 1
        end = match.end()


def same_number(shown, got):
    """Whether a number is the one shown, to the digits shown."""
    digits = shown.lower().lstrip("-").split("e")[0]
    places = len(digits.split(".")[1]) if "." in digits else 0
    exponent = int(shown.lower().split("e")[1]) if "e" in shown.lower() else 0
    unit = 10.0 ** (exponent - places)
    # A whole number of five and more digits may be rounded too: 505075 for 505075.06.
    return math.isclose(float(shown), got, rel_tol=1e-12, abs_tol=0.51 * unit)


class Shown(float):
    """A number with the text in which it is shown."""

    def __new__(cls, text):
        number = super().__new__(cls, text)
        number.text = text
        return number


def compare(shown, got, at="") -> list[str]:
    """Where the output differs from the one that is shown; members and elements may be left out."""
    if isinstance(shown, dict):
        if not isinstance(got, dict):
            return [f"{at}: {got!r}"]
        missing = [f"{at}/{name} is not there" for name in shown if name != "..." and name not in got]
        return missing + [fault for name in shown if name != "..." and name in got for fault in compare(shown[name], got[name], f"{at}/{name}")]
    if isinstance(shown, list):
        if not isinstance(got, list):
            return [f"{at}: {got!r}"]
        if "..." in shown:
            cut = shown.index("...")
            pairs = list(zip(shown[:cut], got)) + (list(zip(shown[cut + 1 :][::-1], got[::-1])))
        elif len(shown) != len(got):
            return [f"{at} has {len(got)} elements, {len(shown)} are shown"]
        else:
            pairs = list(zip(shown, got))
        return [fault for index, (one, other) in enumerate(pairs) for fault in compare(one, other, f"{at}/{index}")]
    if isinstance(shown, Shown) and isinstance(got, (int, float)) and not isinstance(got, bool):
        return [] if same_number(shown.text, got) else [f"{at}: {got}, {shown.text} is shown"]
    return [] if shown in (got, "...") else [f"{at}: {got!r}, {shown!r} is shown"]


def differences(info, shown, got) -> list[str]:
    if info == "json":
        expected = json.loads(shown, parse_float=Shown, parse_int=Shown)
        lines = got.strip().splitlines()
        # A single answer, or lines of JSON.
        try:
            return compare(expected, json.loads(got))
        except json.JSONDecodeError:
            return compare(expected, [json.loads(line) for line in lines])
    parts = []
    for line in shown.rstrip("\n").split("\n"):
        if line.strip() == "...":
            parts.append(r"(?:.*\n)*?")
        elif line.endswith("..."):
            parts.append(re.escape(line[:-3]) + r".*\n")
        else:
            parts.append(re.escape(line.rstrip()) + r"[ \t]*\n")
    return [] if re.fullmatch("".join(parts), got.rstrip("\n") + "\n") else [f"printed:\n{got}"]


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda document: document.stem)
def test_what_a_document_shows_runs_and_prints_what_it_shows(document, service, tmp_path):
    # A relative path of the program would not hold elsewhere.
    programs = tmp_path / "bin"
    programs.mkdir()
    (programs / "reentry").symlink_to(BINARY)
    path = f"{programs}:{Path(sys.executable).parent}:{os.environ['PATH']}"
    environment = {**os.environ, "PATH": path, "TMPDIR": str(tmp_path)}
    printed = None
    for info, text, between, line in blocks(document):
        language = info.split(" ")[0]
        if info in RUN:
            here = re.sub(r"(localhost|127\.0\.0\.1):8080", f"127.0.0.1:{service.port}", text)
            result = subprocess.run(
                [*RUN[language], here], cwd=ROOT, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=60
            )
            assert result.returncode == 0, f"{document.name}:{line}\n{result.stdout[-500:]}{result.stderr[-2000:]}"
            printed = result.stdout
            continue
        assert info in OTHER, f"{document.name}:{line}: a block of {info!r}, which is neither run nor known"
        if info in ("json", "text") and printed is not None and len(between.strip().split("\n\n")) <= 1:
            faults = differences(info, text, printed)
            assert not faults, f"{document.name}:{line}: " + "\n".join(faults)
        printed = None


def test_the_documents_have_blocks_to_run_and_outputs_to_compare():
    infos = [info for document in DOCUMENTS for info, *_ in blocks(document)]
    assert sum(info in RUN for info in infos) > 80
    assert sum(info in ("json", "text") for info in infos) > 80


def test_what_differs_from_what_is_shown_is_seen():
    assert same_number("505075", 505075.06) and not same_number("505075", 505076)
    assert same_number("1.5e-3", 0.00152) and not same_number("1.5e-3", 0.00158)
    assert not differences("json", '{"a": [1, "..."], "...": ""}', '{"a": [1.2, 5], "b": 1}')
    assert differences("json", '{"a": [2, "..."]}', '{"a": [1.2, 5]}')
    assert differences("json", '{"a": 1}', '{"b": 1}')
    assert not differences("text", "time,...\n...\nlast\n", "time,altitude\n1\n2\nlast\n")
    assert differences("text", "time\n", "altitude\n")
