"""A client that openapi-python-client makes of the service's document, as its users have it: typed requests, typed answers."""

import importlib
import json
import math
import os
import re
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest
from conftest import PATIENCE

CASES = Path(__file__).parents[1] / "cases/thesis"
OPENAPI = Path(__file__).parents[2] / "openapi"
OPERATIONS = {
    "reentry": ["analytic", "convert", "corridor", "footprint", "licences", "planets", "simulate", "simulate_batch", "sites", "target", "validation"],
    "health": ["live", "metrics", "ready"],
}


def references():
    """TARGET 1 and 2 and IMPULSE, each under three sets of constants: its request, and its solution by an independent program."""
    for name in ["target_1", "target_2", "impulse"]:
        file = json.loads((CASES / f"{name}.json").read_text())
        for model, expected in file["expected"].items():
            planet = {"model": model, "shape": file["shape"]}
            times = [sample["time"] for sample in expected["samples"]]
            request = {**file["request"], "planet": planet, "output": {"times": times}}
            yield pytest.param(request, expected, id=f"{name}-{model}")


every_reference = pytest.mark.parametrize(("request_", "expected"), list(references()))


@pytest.fixture(scope="module")
def package(service, tmp_path_factory):
    """Where the generator put the client."""
    folder = tmp_path_factory.mktemp("client")
    tools = Path(sys.executable).parent
    command = [tools / "openapi-python-client", "generate", "--url", f"{service.url}/openapi.json", "--meta", "none"]
    command += ["--config", OPENAPI / "python-client.json", "--output-path", folder / "reentry_client", "--fail-on-warning"]
    # It calls ruff by its name.
    environment = {**os.environ, "PATH": f"{tools}:{os.environ['PATH']}"}
    result = subprocess.run(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=5 * PATIENCE)
    assert result.returncode == 0, result.stdout
    assert re.fullmatch(r"Generating \S+\s*", result.stdout), f"the generator complains: {result.stdout}"
    return folder / "reentry_client"


@pytest.fixture(scope="module")
def reentry(service, package):
    """The generated models, and the generated functions, which send to the service."""
    sys.path.insert(0, str(package.parent))
    root = importlib.import_module("reentry_client")
    models = importlib.import_module("reentry_client.models")
    sys.path.pop(0)
    connection = root.Client(base_url=service.url, timeout=PATIENCE, raise_on_unexpected_status=True)

    def function(tag, name):
        module = importlib.import_module(f"reentry_client.api.{tag}.{name}")
        return lambda **arguments: module.sync(client=connection, **arguments)

    functions = {name: function(tag, name) for tag, names in OPERATIONS.items() for name in names}
    return SimpleNamespace(models=models, **functions)


@pytest.mark.parametrize("path", sorted((OPENAPI / "examples").glob("*.json")), ids=lambda path: path.stem)
def test_every_example_is_a_typed_request(reentry, path):
    tree = json.loads(path.read_text())
    kinds = {"state": "Convert", "solution": "Analytic", "achieve": "Target", "resolution": "Footprint", "limits": "Corridor"}
    kind = next((kind for field, kind in kinds.items() if field in tree), "Simulate") + "Request"
    # It writes Z as an offset, and seconds to the microsecond.
    again = json.dumps(getattr(reentry.models, kind).from_dict(tree).to_dict()).replace("+00:00", "Z")
    again = re.sub(r"(\.\d{3})000Z", r"\1Z", again)
    assert json.loads(again) == tree


def place(state):
    """Planet-fixed, m."""
    cosine = math.cos(state["geocentric_latitude"])
    direction = (cosine * math.cos(state["longitude"]), cosine * math.sin(state["longitude"]), math.sin(state["geocentric_latitude"]))
    return [state["radius"] * component for component in direction]


def agree(answer, expected):
    """As exact as the API promises at its default tolerance: a metre, and what follows of it; peaks as in `tests/reference.rs`."""
    end, impact = answer.final_state.to_dict(), expected["final_state"]
    assert answer.termination == expected["termination"]
    assert math.dist(place(end), place(impact)) <= 1.0
    assert end["time"] == pytest.approx(impact["time"], abs=1 / impact["speed"])
    columns = answer.trajectory.to_dict()
    rows = {row["time"]: row for row in (dict(zip(columns, row)) for row in zip(*columns.values()))}
    samples = [sample for sample in expected["samples"] if sample["time"] < end["time"]]
    assert len(samples) >= len(expected["samples"]) - 1
    for sample in samples:
        assert math.dist(place(rows[sample["time"]]), place(sample)) <= 1.0
    for name, peak in expected["peaks"].items():
        found = getattr(answer.peaks, name)
        assert found.value == pytest.approx(peak["value"], rel=1e-8), name
        assert found.time == pytest.approx(peak["time"], abs=2e-4), name


def test_the_client_has_every_operation_and_no_other(package, service):
    found = {path.name: sorted(file.stem for file in path.glob("[a-z]*.py")) for path in (package / "api").iterdir() if path.is_dir()}
    assert {tag: names for tag, names in found.items() if not tag.startswith("_")} == OPERATIONS
    operations = json.loads(service.get("/openapi.json").body)["paths"].values()
    assert sum(len(item) for item in operations) == sum(map(len, OPERATIONS.values()))


def test_every_field_has_a_type_and_every_type_a_name(package):
    """Where a generator does not understand a schema, it says Any; where it has no name for one, it counts."""
    fields = 0
    for file in (package / "models").glob("[a-z]*.py"):
        assert not re.search(r"_type(_\d+)?$|_item_type|additional_property", file.stem), file.stem
        for name, kind in re.findall(r"^    (\w+): (.+)$", file.read_text(), re.MULTILINE):
            fields += 1
            assert name == "additional_properties" or "Any" not in kind, f"{file.stem}.{name}: {kind}"
    assert fields > 300


@every_reference
def test_a_case_that_is_read_from_a_file_flies_as_its_reference(reentry, request_, expected):
    case = reentry.models.SimulateRequest.from_dict(request_)
    assert type(case).from_dict(case.to_dict()) == case
    answer = reentry.simulate(body=case)
    assert isinstance(answer, reentry.models.SimulateResponse), answer
    agree(answer, expected)


def test_a_case_that_is_written_in_python_flies_as_its_reference(reentry):
    models = reentry.models
    file = json.loads((CASES / "impulse.json").read_text())
    expected = file["expected"]["earth_jameson_listing"]
    case = models.SimulateRequest(
        name="impulse",
        angle_unit=models.AngleUnit.RAD,
        planet=models.Planet(model=models.PlanetModel.EARTH_JAMESON_LISTING, shape=models.Shape.ELLIPSOID),
        atmosphere=models.ExponentialAtmosphere(type_="exponential", surface_density=1.54793, scale_height=6935.0),
        vehicle=models.Vehicle(
            mass=1088.64,
            reference_area=1.880022,
            aerodynamics=models.ConstantAerodynamics(type_="constant", drag_coefficient=0.11),
        ),
        initial_state=models.Eci(
            type_="eci",
            position=[1044303.78549, -4866124.54174, 4845298.63761],
            velocity=[-1094.1974, -4187.85837, 2588.77299],
            sidereal_time=200.6,
        ),
        stop=models.Stop(altitude=0, time=10_000),
        output=models.Output(times=[sample["time"] for sample in expected["samples"]]),
    )
    answer = reentry.simulate(body=case)
    assert answer.models.planet == models.PlanetModel.EARTH_JAMESON_LISTING
    agree(answer, expected)


@every_reference
def test_a_state_is_converted_as_its_reference(reentry, request_, expected):
    models = reentry.models
    case = models.SimulateRequest.from_dict(request_)
    answer = reentry.convert(body=models.ConvertRequest(state=case.initial_state, planet=case.planet))
    assert isinstance(answer, models.ConvertResponse), answer
    found, start = answer.planet_relative, expected["initial_state"]
    assert math.dist(place(found.to_dict()), place(start)) <= 1e-3
    assert found.speed == pytest.approx(start["speed"], rel=1e-6)
    assert found.flight_path_angle == pytest.approx(start["flight_path_angle"], abs=1e-9)
    assert math.remainder(found.heading - start["heading"], math.tau) == pytest.approx(0, abs=1e-9)
    # What is answered can be asked with.
    case.initial_state = answer.orbital_elements
    agree(reentry.simulate(body=case), expected)


def test_a_bad_case_comes_back_as_a_problem_with_every_fault(reentry):
    models = reentry.models
    case = models.SimulateRequest.from_dict(json.loads((CASES / "target_2.json").read_text())["request"])
    case.vehicle.mass = -700.0
    case.initial_state.heading = 400.0
    answer = reentry.simulate(body=case)
    assert isinstance(answer, models.Problem), answer
    assert (answer.status, answer.type_) == (422, "/problems/invalid-case")
    assert [error.pointer for error in answer.errors] == ["/vehicle/mass", "/initial_state/heading"]
    assert all(isinstance(error, models.FieldError) and "must be" in error.detail for error in answer.errors)
    assert isinstance(reentry.convert(body=models.ConvertRequest(state=case.initial_state)), models.Problem)


def test_a_batch_a_theory_and_the_rest_answer(reentry):
    models = reentry.models
    good = models.SimulateRequest.from_dict(json.loads((OPENAPI / "examples/target_1.json").read_text()))
    bad = models.SimulateRequest.from_dict({**good.to_dict(), "density_factor": -1})
    flight, problem = map(json.loads, reentry.simulate_batch(body=[good, bad]).splitlines())
    assert models.SimulateResponse.from_dict(flight).termination == models.Termination.SURFACE_IMPACT
    assert models.Problem.from_dict(problem).errors[0].pointer == "/density_factor"
    theory = models.AnalyticRequest.from_dict(json.loads((OPENAPI / "examples/steep_ballistic.json").read_text()))
    answer = reentry.analytic(body=theory)
    assert isinstance(answer, models.AnalyticResponse), answer
    assert answer.solution == models.Solution.STEEP_BALLISTIC
    assert reentry.validation().passed
    assert (reentry.live().status, reentry.ready().status) == ("ok", "ok")
