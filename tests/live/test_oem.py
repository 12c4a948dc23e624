"""Orbit Ephemeris Messages, as the package beyond reads them, which has the frames of the IERS and of older conventions of its own."""

import csv
import io
import json
from datetime import timedelta
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from beyond.config import config
from beyond.dates import Date
from beyond.io import ccsds
from beyond.orbits import Ephem
from conftest import run

EXAMPLES = Path(__file__).parents[2] / "openapi/examples"
EPOCH = "2026-11-22T12:00:00Z"
START = Date.strptime(EPOCH, "%Y-%m-%dT%H:%M:%SZ")
# Like the service, without polar motion and UT1-UTC.
config.update({"eop": {"missing_policy": "pass"}})


def example(name, **fields):
    """A case of the guide, with an epoch and the default rows."""
    case = json.loads((EXAMPLES / f"{name}.json").read_text())
    case.pop("output", None)
    return {**case, "epoch": EPOCH, **fields}


KICK = {"when": {"quantity": "altitude", "falls_through": 110e3}, "then": {"delta_v": {"along": "normal", "value": 50}}}
CASES = {
    "a burn, separations and parachutes": example("deorbit"),
    "a bank schedule": example("lifting_capsule"),
    "an impulse": example("lifting_capsule", events=[KICK]),
}
every_case = pytest.mark.parametrize("flight", CASES.values(), ids=CASES)


@pytest.fixture
def written(tmp_path):
    """Writes a case to a file of a format, and reads its text."""

    def written(flight, format):
        source, path = tmp_path / "case.json", tmp_path / f"flight.{format}"
        source.write_text(json.dumps(flight))
        result = run("simulate", str(source), "--format", format, "--output", str(path))
        assert result.returncode == 0, result.stderr
        return path.read_text()

    return written


def segments(message):
    """The segments of a message."""
    read = ccsds.loads(message)
    return [read] if isinstance(read, Ephem) else read


def seconds(state):
    """Since the start, s."""
    return (state.date - START) / timedelta(seconds=1)


def rows(table):
    """Time since the start, s, by date, and planet-fixed position, m, of a CSV with angles in degrees."""
    places = {}
    for row in csv.DictReader(io.StringIO(table)):
        radius, longitude, latitude = float(row["radius"]), *(np.radians(float(row[name])) for name in ("longitude", "geocentric_latitude"))
        place = radius * np.array([np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude), np.sin(latitude)])
        places[row["utc"].rstrip("Z")] = place
    return places


def cubic(before, after, instant):
    """The position at an instant between two states, by the polynomial of third degree that the message recommends."""
    span = seconds(after) - seconds(before)
    part = (instant - seconds(before)) / span
    here, there = np.array(before), np.array(after)
    return (
        (1 + 2 * part) * (1 - part) ** 2 * here[:3]
        + part * (1 - part) ** 2 * span * here[3:]
        + part**2 * (3 - 2 * part) * there[:3]
        + part**2 * (part - 1) * span * there[3:]
    )


@every_case
def test_a_reader_finds_the_places_of_the_table(written, flight):
    places = rows(written(flight, "csv"))
    read = segments(written(flight, "oem"))
    found = 0
    for segment in read:
        assert (segment.name, segment.cospar_id, segment.frame.name) == (flight["name"], "UNKNOWN", "GCRF")
        # The reader takes a millisecond and more for each.
        for state in [*list(segment)[::7], list(segment)[-1]]:
            place = places.get(f"{state.date:%Y-%m-%dT%H:%M:%S.%f}")
            if place is not None:
                # The nutation of the service is good to 1.5 m.
                assert np.linalg.norm(np.array(state.copy(frame="ITRF"))[:3] - place) < 2
                found += 1
    assert found > len(places) / 7


@every_case
def test_the_recommended_interpolation_follows_the_flight(written, flight):
    coarse, fine = (segments(written({**flight, "output": {"samples_per_step": rows}}, "oem")) for rows in (4, 20))
    assert [len(segment) > 1 for segment in coarse] == [True] * len(fine)
    worst = 0
    for segment, truth in zip(coarse, fine):
        pairs = pairwise(segment)
        before, after = next(pairs)
        for state in truth:
            while seconds(state) > seconds(after):
                before, after = next(pairs)
            off = np.linalg.norm(cubic(before, after, seconds(state)) - np.array(state)[:3])
            worst = max(worst, off)
    # What the guide says.
    assert worst < 0.3


@every_case
def test_velocities_are_those_of_the_places(written, flight):
    for segment in segments(written({**flight, "output": {"interval": 0.1}}, "oem")):
        states = list(segment)
        for before, here, after in zip(states, states[1:], states[2:]):
            span = seconds(after) - seconds(before)
            if abs(span - 0.2) < 1e-9:
                moved = (np.array(after)[:3] - np.array(before)[:3]) / span
                # Rows of a millimetre, and a third derivative of some 100 m/s³ where the drag changes fast.
                assert np.linalg.norm(moved - np.array(here)[3:]) < 0.2


def test_segments_meet_where_they_jump(written):
    coast, rest = segments(written(CASES["an impulse"], "oem"))[:2]
    before, after = list(coast)[-1], next(iter(rest))
    assert before.date == after.date
    jump = np.array(after) - np.array(before)
    # Both are moved on to their date as it is written, by half a microsecond at most.
    assert np.linalg.norm(jump[:3]) < 3e-5
    assert abs(np.linalg.norm(jump[3:]) - 50) < 1e-6


def test_a_message_is_that_of_the_service(service, written):
    flight = CASES["a bank schedule"]
    answer = service.request("POST", "/simulate?format=oem", json.dumps(flight), {"content-type": "application/json"})
    assert answer.status == 200
    assert answer.headers["content-type"] == "text/vnd.ccsds.oem; charset=us-ascii"

    def undated(message):
        return [line for line in message.splitlines() if not line.startswith("CREATION_DATE")]

    assert undated(answer.body.decode("ascii")) == undated(written(flight, "oem"))


def test_the_message_was_made_just_now(written):
    before = Date.now()
    line = written(CASES["a bank schedule"], "oem").splitlines()[2]
    made = Date.strptime(line.removeprefix("CREATION_DATE = "), "%Y-%m-%dT%H:%M:%S.%f")
    assert before - timedelta(seconds=1) < made < Date.now() + timedelta(seconds=1)


def test_a_list_is_no_message(tmp_path):
    path = tmp_path / "cases.json"
    path.write_text(json.dumps([CASES["a bank schedule"]] * 2))
    refused = run("simulate", str(path), "--format", "oem")
    assert (refused.returncode, refused.stdout) == (1, "")
    assert "must be a single case for OEM, not a list: a message has the states of one object" in refused.stderr
