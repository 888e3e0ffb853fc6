"""The server accepts its own host names, and opens its sockets to its own pages."""

import pytest

from server.security.hosts import KnownHosts, is_same_origin


@pytest.mark.parametrize(
    ("host", "known"),
    [
        ("127.0.0.1:8000", True),
        ("localhost", True),
        ("LOCALHOST:8000", True),
        ("[::1]:8000", True),
        ("192.168.1.20:8000", True),
        ("theatre-3.hospital.example:8000", True),
        ("evil.example", False),
        ("127.0.0.1.evil.example", False),
        ("localhost.evil.example", False),
        ("[::1", False),
        ("user@evil.example", False),
        ("", False),
    ],
)
def test_a_host_is_known_by_name_or_is_an_address(host: str, known: bool) -> None:
    assert KnownHosts.of("Theatre-3.hospital.example").has(host) == known


@pytest.mark.parametrize(
    ("origin", "host", "same"),
    [
        pytest.param(None, "localhost:8000", True, id="not-a-browser"),
        pytest.param("http://localhost:8000", "localhost:8000", True, id="own-page"),
        pytest.param("http://LOCALHOST:8000", "localhost:8000", True, id="names-have-no-case"),
        pytest.param("https://ward.example", "ward.example:443", True, id="default-port"),
        pytest.param("https://ward.example", "ward.example", True, id="behind-a-proxy-with-tls"),
        pytest.param("http://localhost:3000", "localhost:8000", False, id="another-port"),
        pytest.param("http://evil.example", "localhost:8000", False, id="another-host"),
        pytest.param("http://localhost", "localhost:8000", False, id="port-left-out"),
        pytest.param("null", "localhost:8000", False, id="page-without-origin"),
        pytest.param("file://", "localhost:8000", False, id="a-file"),
        pytest.param("http://localhost:99999", "localhost:8000", False, id="no-port-at-all"),
        pytest.param("http://", "", False, id="nothing"),
        pytest.param("http://theatre:8000", "theatre:8000", True, id="own-page-by-another-name"),
        pytest.param("http://theatre:8000", "", False, id="no-host"),
        pytest.param("http://[", "theatre:8000", False, id="no-address-at-all"),
        pytest.param("", "theatre:8000", False, id="empty-origin"),
    ],
)
def test_only_own_pages_open_sockets(origin: str | None, host: str, same: bool) -> None:
    assert is_same_origin(origin=origin, host=host) == same
