"""More than the service can serve, by the program of `make load`: what holds on a slow and busy machine, too."""

import os
import subprocess
from pathlib import Path

from conftest import BINARY, PATIENCE

# `cargo test` builds it beside the tests.
OVERLOAD = os.environ.get("OVERLOAD", str(Path(__file__).parents[2] / "target/debug/examples/overload"))


def test_a_flood_is_served_or_refused_and_leaves_nothing_behind():
    run = subprocess.run(
        [OVERLOAD, "brief"], env={**os.environ, "REENTRY": BINARY}, capture_output=True, text=True, timeout=2 * PATIENCE
    )
    print(run.stdout)
    assert run.returncode == 0, run.stderr
