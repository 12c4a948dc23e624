"""Maps: valid by the schema of their format, and opened by what reads them.

GDAL is what QGIS opens files with. The schemas of KML are those of OGC and Google, which fastkml brings; czml3 and geojson-pydantic
know every property of their formats and refuse any other.
"""

import json
import struct
from pathlib import Path

import fastkml
import pyogrio
import pytest
from conftest import run
from czml3 import Document
from fastkml.validator import validate
from geojson_pydantic import FeatureCollection

EXAMPLES = Path(__file__).parents[2] / "openapi/examples"
CAPSULE = json.loads((EXAMPLES / "lifting_capsule.json").read_text())
KML_SCHEMA = Path(fastkml.__file__).parent / "schema/kml22gx.xsd"
FORMATS = ["geojson", "kml", "czml"]


def case(longitude=170, epoch=None, **fields):
    """A capsule that flies over the antimeridian, or elsewhere."""
    state = {"type": "planet_relative", "altitude": 120e3, "geocentric_latitude": 10, "speed": 7500, "flight_path_angle": -3, "heading": 20}
    vehicle = {"mass": 1000, "reference_area": 1, "aerodynamics": {"type": "constant", "drag_coefficient": 1}}
    dated = {"epoch": epoch} if epoch else {}
    return {"angle_unit": "deg", "vehicle": vehicle, "initial_state": {**state, "longitude": longitude}, **dated, **fields}


# Two orbits over the poles, and a flight that ends where it starts.
POLAR = case(
    atmosphere={"type": "vacuum"}, stop={"time": 11000}, initial_state={"type": "eci", "position": [6.8e6, 0, 0], "velocity": [0, 0, 7656]}
)
ON_GROUND = case(initial_state={**case()["initial_state"], "altitude": 0, "speed": 0})
EPOCH = "2026-11-22T12:00:00Z"
CASES = {
    "a capsule": {**CAPSULE, "output": {"interval": 5}, "name": "a <b>&\"'\x01</b> ]]> ü"},
    "events and heat": json.loads((EXAMPLES / "deorbit.json").read_text()),
    "the antimeridian": case(),
    "the antimeridian, dated": case(epoch=EPOCH),
    "elsewhere": case(longitude=-60),
    "the poles": POLAR,
    "the poles, dated": {**POLAR, "epoch": EPOCH},
    "on the ground": ON_GROUND,
    "on the ground, dated": {**ON_GROUND, "epoch": EPOCH},
}
every_case = pytest.mark.parametrize("flight", CASES.values(), ids=CASES)


@pytest.fixture
def drawn(tmp_path):
    """Writes a map of a case to a file."""

    def drawn(flight, format):
        source, path = tmp_path / "case.json", tmp_path / f"track.{format}"
        source.write_text(json.dumps(flight))
        result = run("simulate", str(source), "--format", format, "--output", str(path))
        assert result.returncode == 0, result.stderr
        return path

    return drawn


def lines(wkb):
    """The lines of a geometry, or its point, as lists of longitude, latitude and altitude."""
    kind, count = struct.unpack_from("<xII", wkb)
    points = {1: 1, 2: count}.get(kind % 0x80000000)
    if points:
        start = 5 if points == 1 and kind % 0x80000000 == 1 else 9
        return [[list(point) for point in struct.iter_unpack("<3d", wkb[start : start + 24 * points])]]
    parts, at = [], 9
    for _ in range(count):
        (length,) = struct.unpack_from("<5xI", wkb, at)
        parts += lines(wkb[at : at + 9 + 24 * length])
        at += 9 + 24 * length
    return parts


def opened(path):
    """The features that GDAL finds in a file: their geometries and properties."""
    meta, _, geometries, columns = pyogrio.raw.read(path)
    assert meta["crs"] == "EPSG:4326"
    rows = [dict(zip(meta["fields"], row)) for row in zip(*columns)]
    return list(zip(geometries, rows))


@every_case
def test_geojson_is_valid_and_opens(drawn, flight):
    path = drawn(flight, "geojson")
    written = json.loads(path.read_text())
    FeatureCollection.model_validate(written)
    features = opened(path)
    assert len(features) == len(written["features"])
    for (geometry, properties), feature in zip(features, written["features"]):
        coordinates = feature["geometry"]["coordinates"]
        nesting = {"Point": [[coordinates]], "LineString": [coordinates], "MultiLineString": coordinates}
        assert lines(geometry) == nesting[feature["geometry"]["type"]]
        assert properties["name"] == feature["properties"]["name"]
        if feature["properties"]["kind"] != "track":
            # A point has numbers and a date, not texts or lists.
            assert properties["time"] == feature["properties"]["time"]
            assert properties["value"] == feature["properties"]["value"]
            assert ("utc" in properties) == ("epoch" in flight)
            assert "epoch" not in flight or properties["utc"].dtype.kind == "M"


@every_case
def test_kml_is_valid_and_opens(drawn, flight):
    path = drawn(flight, "kml")
    assert validate(file_to_validate=path, schema=KML_SCHEMA)
    points = json.loads(drawn(flight, "geojson").read_text())["features"][1:]
    rows = run("simulate", str(path.with_name("case.json")), "--format", "csv").stdout.splitlines()[1:]
    (track, properties), *marks = opened(path)
    (line,) = lines(track)
    assert len(line) == len(rows)
    assert properties["Name"] == flight.get("name", "flight").replace("\x01", "\ufffd")
    assert str(properties["begin"]).startswith(flight.get("epoch", "NaT")[:16])
    assert [lines(geometry)[0][0] for geometry, _ in marks] == [point["geometry"]["coordinates"] for point in points]
    for (_, properties), point in zip(marks, points):
        assert properties["Name"] == point["properties"]["name"]
        assert float(properties["value"]) == point["properties"]["value"]
        assert properties["altitudeMode"] == "absolute"


@every_case
def test_czml_is_valid(drawn, flight):
    packets = json.loads(drawn(flight, "czml").read_text())
    document = Document.model_validate({"packets": packets})
    assert document.packets[0].id == "document"
    assert len({packet.id for packet in document.packets}) == len(packets)


@pytest.mark.parametrize("format", FORMATS)
def test_a_map_is_that_of_the_service(service, drawn, format):
    flight = CASES["a capsule"]
    answer = service.request("POST", f"/simulate?format={format}", json.dumps(flight), {"content-type": "application/json"})
    assert answer.status == 200
    assert drawn(flight, format).read_bytes().rstrip(b"\n") == answer.body


def test_a_list_gives_a_map_a_line(tmp_path):
    path = tmp_path / "cases.json"
    path.write_text(json.dumps([case(), {**case(), "colour": "red"}, POLAR]))
    for format, is_map in [("geojson", lambda line: line["type"] == "FeatureCollection"), ("czml", lambda line: line[0]["id"] == "document")]:
        result = run("simulate", str(path), "--format", format)
        assert result.returncode == 1
        first, problem, last = [json.loads(line) for line in result.stdout.splitlines()]
        assert is_map(first) and is_map(last) and problem["status"] == 422
    refused = run("simulate", str(path), "--format", "kml")
    assert (refused.returncode, refused.stdout) == (1, "")
    assert refused.stderr.startswith(f"reentry: {path}: Case not valid: 1 problem in the request\n  must be a single case for KML")


@pytest.mark.parametrize("format", FORMATS)
def test_a_theory_is_no_map(format):
    refused = run("analytic", "case.json", "--format", format)
    assert refused.returncode == 2
    assert "possible values: json, csv" in refused.stderr
