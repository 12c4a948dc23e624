"""The metrics, as Prometheus reads them."""

import re
from pathlib import Path

from conftest import ORBIT
from prometheus_client.openmetrics.parser import text_string_to_metric_families

OPERATIONS = Path(__file__).parents[2] / "crates/service/guide/operations.md"
QUICK = {**ORBIT, "stop": {"time": 1}}


def samples(answer):
    """Every sample, by its name."""
    found = {}
    for family in text_string_to_metric_families(answer.body.decode()):
        for sample in family.samples:
            found.setdefault(sample.name, []).append(sample)
    return found


def test_prometheus_reads_them(service):
    for _ in range(3):
        assert service.simulate(QUICK).status == 200
    found = samples(service.get("/metrics"))
    ended = [sample for sample in found["reentry_requests_total"] if sample.labels == {"route": "/simulate", "outcome": "ok"}]
    assert [sample.value for sample in ended] == [3]
    assert found["reentry_resident_memory_bytes"][0].value > 1e6
    assert found["reentry_connections"][0].value >= 1
    # Times are where they are looked for: most of these flights in the first buckets, and none in the last alone.
    buckets = [sample for sample in found["reentry_compute_seconds_bucket"] if sample.labels["route"] == "/simulate"]
    assert buckets[-1].labels["le"] == "+Inf"
    assert buckets[-2].value == buckets[-1].value == 3


def test_what_the_readme_asks_for_is_there(start):
    service = start("--rate-limit", "1000")
    service.simulate(QUICK)
    service.simulate({})
    names = set(samples(service.get("/metrics")))
    asked = set(re.findall(r"\breentry_[a-z_]+\b", OPERATIONS.read_text()))
    # Appears with the first of its kind.
    missing = asked - names - {"reentry_cancellations_total", "reentry_client", "reentry_searches_total"}
    assert not missing


def test_with_an_address_of_their_own_they_are_nowhere_else(start):
    service = start("--metrics-listen", "127.0.0.1:0")
    assert service.get("/metrics").status == 404
    address = re.search(r"metrics on http://127\.0\.0\.1:(\d+)/metrics", service.log.read_text())
    service.port = int(address[1])
    assert "reentry_build_info" in samples(service.get("/metrics"))
    assert service.get("/simulate").status == 404
