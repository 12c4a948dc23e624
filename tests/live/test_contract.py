"""The OpenAPI document, and whether the service keeps to it."""

import json
import subprocess
import sys
from pathlib import Path

from openapi_spec_validator import validate

EXAMPLES = 250


def test_the_document_is_valid(service):
    validate(json.loads(service.get("/openapi.json").body))


def test_the_service_keeps_to_the_document(service, tmp_path):
    settings = Path(__file__).with_name("schemathesis.toml")
    command = [Path(sys.executable).with_name("schemathesis"), "--config-file", settings, "run", f"{service.url}/openapi.json"]
    # Of all checks, those of authorisation and of things that are made and deleted have nothing to look at here.
    command += ["--checks", "all", "--continue-on-failure", "--no-color"]
    # The same requests in every run; a slow machine is no failure.
    command += ["--seed", "1", "--max-examples", str(EXAMPLES), "--generation-database", "none"]
    command += ["--suppress-health-check", "too_slow", "--request-timeout", "60"]
    result = subprocess.run(command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=1200)
    print(result.stdout)
    assert result.returncode == 0
    for phase in ["Examples", "Coverage", "Fuzzing", "Stateful"]:
        assert f"\n  ✅ {phase}\n" in result.stdout, f"{phase} did not run"
