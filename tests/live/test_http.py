"""HTTP on the wire: compression, sizes of bodies, the page at / and those under /docs."""

import gzip
import re
from html.parser import HTMLParser
from urllib.parse import urljoin, urlsplit

import pytest

LIMIT = 1 << 20
JSON = {"content-type": "application/json"}


@pytest.mark.parametrize(
    ("accepted", "encoding", "magic"),
    [
        ("zstd, gzip", "zstd", b"\x28\xb5\x2f\xfd"),
        ("gzip, deflate, br, zstd", "zstd", b"\x28\xb5\x2f\xfd"),
        ("gzip", "gzip", b"\x1f\x8b"),
        ("gzip, deflate, br", "gzip", b"\x1f\x8b"),
        ("br", None, b"{"),
        ("identity", None, b"{"),
    ],
)
def test_a_large_answer_is_compressed_as_the_client_accepts(service, accepted, encoding, magic):
    answer = service.get("/openapi.json", {"accept-encoding": accepted})
    assert answer.headers["content-encoding"] == encoding
    assert answer.body.startswith(magic)
    assert "accept-encoding" in answer.headers["vary"].lower()


def test_a_compressed_answer_is_the_same_answer(service):
    packed = service.get("/openapi.json", {"accept-encoding": "gzip"})
    assert gzip.decompress(packed.body) == service.get("/openapi.json").body


def test_a_small_answer_is_not_compressed(service):
    answer = service.get("/health/live", {"accept-encoding": "zstd, gzip"})
    assert answer.headers["content-encoding"] is None


def test_a_body_declared_too_long_is_refused(service):
    answer = service.request("POST", "/simulate", b" " * (LIMIT + 1), JSON)
    assert answer.status == 413
    assert answer.problem()["type"] == "/problems/payload-too-large"


def test_a_body_too_long_in_chunks_is_refused(service):
    chunks = (b" " * size for size in [1 << 16] * (LIMIT >> 16) + [1])
    answer = service.request("POST", "/simulate", chunks, JSON, encode_chunked=True)
    assert answer.status == 413
    assert answer.problem()["type"] == "/problems/payload-too-large"


def test_a_body_as_long_as_allowed_is_read(service):
    assert service.request("POST", "/simulate", b" " * LIMIT, JSON).status == 400


def test_the_docs_load_nothing_from_elsewhere(service):
    page = service.get("/docs/")
    assert page.status == 200
    found = References()
    found.feed(page.body.decode())
    assert len(found.references) >= 4
    for reference in found.references:
        asset = served(service, "/docs/", reference)
        if reference.endswith(".css"):
            for inner in re.findall(r"url\(\s*[\"']?([^\"')]+)", asset.body.decode()):
                if not inner.startswith("data:"):
                    served(service, urljoin("/docs/", reference), inner)
    settings = service.get("/docs/swagger-initializer.js").body.decode()
    served(service, "/docs/", re.search(r'"url": "([^"]+)"', settings)[1])
    # Left alone, the page sends every document to the validator of swagger.io and shows its badge.
    assert re.search(r'"validatorUrl": "none"', settings), settings


def test_the_page_is_the_same_in_every_coding(service):
    page = service.get("/")
    found = References()
    found.feed(page.body.decode())
    scripts = [reference for reference in found.references if reference.endswith(".js")]
    assert scripts, "the page was not built"
    for reference in ["/", *found.references]:
        plain = served(service, "/", reference)
        path = urlsplit(urljoin(service.url, reference)).path
        if path == "/" or path.startswith("/assets/"):
            packed = service.get(path, {"accept-encoding": "gzip"})
            assert packed.headers["content-encoding"] == "gzip", path
            assert gzip.decompress(packed.body) == plain.body, path
            smallest = service.get(path, {"accept-encoding": "gzip, deflate, br, zstd"})
            assert smallest.headers["content-encoding"] == "br", path
            assert len(smallest.body) < len(packed.body), path


class References(HTMLParser):
    """Collects what a page loads."""

    def __init__(self):
        super().__init__()
        self.references = []

    def handle_starttag(self, tag, attrs):
        self.references += [value for name, value in attrs if name in ("src", "href")]


def served(service, base, reference):
    """The answer of the service itself to a reference."""
    target = urljoin(service.url + base, reference)
    assert target.startswith(service.url + "/"), f"{reference} is elsewhere"
    answer = service.get(urlsplit(target).path)
    assert answer.status == 200, reference
    return answer
