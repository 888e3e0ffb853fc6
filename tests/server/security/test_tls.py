"""TLS: when it is used, with which certificate, and video over it."""

import contextlib
import hashlib
import json
import os
import re
import signal
import socket
import ssl
import subprocess
import sys
import urllib.request
from collections.abc import Iterator
from contextlib import ExitStack
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest
from websockets.sync.client import connect

from server.app import AppParts, create_app
from server.config import Config
from server.errors import ConfigError
from server.live import LiveHub
from server.security.tls import handshake, reject_unsafe, select_dicom_tls, select_tls, self_signed
from server.security.tls.selection import PROXY_SPEAKS_TLS
from server.security.tls.self_signed import load_or_create
from tests.served import served

REPOSITORY = Path(__file__).parents[3]


def config_of(**server: object) -> Config:
    return Config.model_validate({"server": server})


@pytest.mark.parametrize("host", ["127.0.0.1", "::1", "localhost", "127.3.2.1"])
def test_on_loopback_no_tls_is_spoken(tmp_path: Path, host: str) -> None:
    assert select_tls(config_of(host=host), tmp_path) is None


def test_on_any_other_address_it_is_with_a_certificate_of_our_own_making(tmp_path: Path) -> None:
    tls = select_tls(config_of(host="0.0.0.0"), tmp_path)  # noqa: S104  nothing listens
    assert tls is not None
    assert tls.is_self_signed
    assert re.fullmatch(r"([0-9A-F]{2}:){31}[0-9A-F]{2}", tls.fingerprint)
    assert tls.key.stat().st_mode & 0o077 == 0
    again = select_tls(config_of(host="0.0.0.0"), tmp_path)  # noqa: S104  nothing listens
    assert again == tls, "browsers were told to believe this one"


def test_a_proxy_speaks_it_only_where_the_settings_say_so_in_words(tmp_path: Path) -> None:
    said = config_of(host="0.0.0.0", behind_proxy="a proxy speaks TLS for this server")  # noqa: S104
    assert select_tls(said, tmp_path) is None
    with pytest.raises(ValueError, match="behind_proxy"):
        config_of(behind_proxy="yes")


def test_without_sign_in_no_other_address_is_served() -> None:
    off = Config.model_validate({"server": {"host": "192.0.2.1"}, "security": {"sign_in": "off"}})
    with pytest.raises(ConfigError) as reported:
        reject_unsafe(off)
    assert reported.value.code == "SIGN_IN_NEEDED"
    reject_unsafe(Config.model_validate({"security": {"sign_in": False}}))
    proxied = {"server": {"behind_proxy": PROXY_SPEAKS_TLS}, "security": {"sign_in": "off"}}
    with pytest.raises(ConfigError) as reported:
        reject_unsafe(Config.model_validate(proxied))
    assert reported.value.code == "SIGN_IN_NEEDED"
    reject_unsafe(config_of(host="192.0.2.1"))


def test_poses_leave_this_computer_unencrypted_only_where_the_settings_say_so_in_words() -> None:
    shared = {"port": 18944, "host": "192.0.2.1"}
    with pytest.raises(ConfigError) as reported:
        reject_unsafe(Config.model_validate({"openigtlink": shared}))
    assert reported.value.code == "OPENIGTLINK_UNENCRYPTED"
    said = {**shared, "unencrypted": "anybody who reaches this port reads the poses"}
    for allowed in (said, {**shared, "port": None}, {"port": 18944}, {"port": 18944, "host": "::1"}):
        reject_unsafe(Config.model_validate({"openigtlink": allowed}))
    with pytest.raises(ValueError, match="unencrypted"):
        Config.model_validate({"openigtlink": {**shared, "unencrypted": "yes"}})


def test_poses_come_from_another_computer_only_where_the_settings_say_so_in_words() -> None:
    names = ["DrillToTracker", "PatientToTracker"]
    shared = {"host": "192.0.2.1", "transforms": names, "sd_mm": 0.2, "sd_deg": 0.2, "latency_ms": 40.0}
    with pytest.raises(ConfigError) as reported:
        reject_unsafe(Config.model_validate({"external_tracker": shared}))
    assert reported.value.code == "TRACKER_UNENCRYPTED"
    said = {**shared, "unencrypted": "anybody on this network can change the poses"}
    for allowed in (said, {**shared, "host": "127.0.0.1"}, None):
        reject_unsafe(Config.model_validate({"external_tracker": allowed}))


def test_cts_arrive_unencrypted_only_where_the_settings_say_so_in_words() -> None:
    shared = {"port": 11112, "host": "192.0.2.1"}
    with pytest.raises(ConfigError) as reported:
        reject_unsafe(Config.model_validate({"dicom": {"receive": shared}}))
    assert reported.value.code == "DICOM_UNENCRYPTED"
    said = {**shared, "unencrypted": "anybody on this network reads the patients' data"}
    for allowed in (said, {**shared, "tls": True}, {**shared, "port": None}, {"port": 11112}):
        reject_unsafe(Config.model_validate({"dicom": {"receive": allowed}}))


def test_dicom_has_the_certificate_of_the_server_or_one_of_its_own(
    tmp_path: Path, own: dict[str, Path]
) -> None:
    plain = Config.model_validate({"dicom": {"receive": {"port": 11112}}})
    assert select_dicom_tls(plain, tmp_path) is None
    receive = {"dicom": {"receive": {"port": 11112, "tls": True}}}
    made = select_dicom_tls(Config.model_validate(receive), tmp_path)
    assert made is not None
    assert made.is_self_signed
    files = {part: own[part] for part in ("certificate", "key")}
    given = select_dicom_tls(Config.model_validate({**receive, "server": {"tls": files}}), tmp_path)
    assert given is not None
    assert given.certificate == own["certificate"]


@pytest.mark.parametrize("what", ["plan", "registration"])
def test_without_sign_in_there_is_no_second_person(what: str) -> None:
    required = {"supervision": {"cosign": {what: "required"}}}
    reject_unsafe(Config.model_validate(required))
    with pytest.raises(ConfigError) as reported:
        reject_unsafe(Config.model_validate({**required, "security": {"sign_in": "off"}}))
    assert reported.value.code == "SIGN_IN_NEEDED"
    assert "cosign" in reported.value.message


def test_who_connects_and_does_not_finish_the_handshake_is_cut_off(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(handshake, "HANDSHAKE_TIMEOUT_S", 1.0)
    tls = select_tls(config_of(host="0.0.0.0"), tmp_path)  # noqa: S104  nothing listens there
    assert tls is not None
    app = create_app(AppParts(hub=LiveHub(), config=Config()))
    trusting = ssl.create_default_context(cafile=str(tls.certificate))
    trusting.check_hostname = False
    # The connections end before the server, whose close would otherwise wait for an answer.
    with served(app, tls=tls) as port, ExitStack() as lines:

        def connected() -> socket.socket:
            # asyncio alone would keep each of them for 60 s.
            return lines.enter_context(socket.create_connection(("127.0.0.1", port), timeout=20.0))

        silent, halting, whole = connected(), connected(), connected()
        # The first bytes of a handshake that never ends.
        halting.sendall(b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03")
        chained_line = lines.enter_context(trusting.wrap_socket(whole))
        wait_for_end(silent)
        wait_for_end(halting)
        # A completed handshake has no further time limit.
        chained_line.sendall(b"GET /health HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n")
        assert chained_line.recv(1024).startswith(b"HTTP/1.1 ")


def wait_for_end(line: socket.socket) -> None:
    """Until the other side closes it; TimeoutError if it does not."""
    with contextlib.suppress(ConnectionResetError):
        while line.recv(1024):
            pass


def test_a_self_signed_certificate_is_renewed_when_it_expires_or_lacks_a_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def pem(host: str = "192.0.2.1", **later: float) -> bytes:
        now = datetime.now(tz=UTC) + timedelta(**later)
        return load_or_create(tmp_path, host=host, clock=lambda: now).certificate.read_bytes()

    first = pem()
    assert pem() == first
    assert pem(days=300) == first
    second = pem(days=370)
    assert second != first
    third = pem("ward-3.example", days=370)
    assert third != second
    assert pem("ward-3.example", days=370) == third
    (tmp_path / "key.pem").chmod(0o644)
    assert pem("ward-3.example", days=370) != third, "others may have read the key"
    monkeypatch.setattr(self_signed, "outbound_address", lambda: "198.51.100.3")
    assert b"BEGIN CERTIFICATE" in pem()


@pytest.fixture
def own(tmp_path: Path) -> dict[str, Path]:
    """User-provided certificates, valid and invalid."""
    one, other = (load_or_create(tmp_path / name, host="localhost") for name in ("one", "other"))
    locked, text = tmp_path / "locked.pem", tmp_path / "text.pem"
    text.write_text("no certificate at all")
    from cryptography.hazmat.primitives import serialization as forms  # noqa: PLC0415

    key = forms.load_pem_private_key(one.key.read_bytes(), password=None)
    chained_line = forms.BestAvailableEncryption(b"secret")
    locked.write_bytes(key.private_bytes(forms.Encoding.PEM, forms.PrivateFormat.PKCS8, chained_line))
    return {
        "certificate": one.certificate,
        "key": one.key,
        "other": other.key,
        "locked": locked,
        "text": text,
        "missing": tmp_path / "none.pem",
    }


@pytest.mark.parametrize(
    ("certificate", "key", "said"),
    [
        pytest.param("missing", "key", "cannot be read: no such file", id="no file"),
        pytest.param("text", "key", "is no PEM file", id="no certificate"),
        pytest.param("certificate", "text", "is no PEM file", id="no key"),
        pytest.param("certificate", "other", "does not match the key", id="another key"),
        pytest.param("certificate", "locked", "is protected by a password", id="a locked key"),
        pytest.param("key", "key", "cannot be used with its key", id="a key for a certificate"),
    ],
)
def test_a_certificate_that_cannot_be_served_is_reported(
    own: dict[str, Path], tmp_path: Path, certificate: str, key: str, said: str
) -> None:
    files = {"certificate": own[certificate], "key": own[key]}
    with pytest.raises(ConfigError) as reported:
        select_tls(config_of(tls=files), tmp_path)
    assert reported.value.code == "CERTIFICATE_UNUSABLE"
    assert said in reported.value.message


def test_a_good_one_is_served_on_loopback_too_and_half_of_one_is_rejected(
    own: dict[str, Path], tmp_path: Path
) -> None:
    tls = select_tls(config_of(tls={"certificate": own["certificate"], "key": own["key"]}), tmp_path)
    assert tls is not None
    assert not tls.is_self_signed
    with pytest.raises(ConfigError) as reported:
        reject_unsafe(config_of(tls={"key": own["key"]}))
    assert reported.value.code == "TLS_HALF"


@pytest.fixture
def under_tls(own: dict[str, Path], tmp_path: Path) -> Iterator[tuple[list[str], Path]]:
    """`coaxial run` with a certificate; its output, and the certificate."""
    settings = {
        "server": {"tls": {"certificate": str(own["certificate"]), "key": str(own["key"])}},
        "rehearsal": {"width": 1280, "height": 720, "rate_hz": 10},
        "video": {"jpeg_quality": 100},
    }
    (tmp_path / "config.yaml").write_text(json.dumps(settings))
    environment = {**os.environ, "PYTHONPATH": str(REPOSITORY), "COAXIAL_HOME": str(tmp_path / "home")}
    with subprocess.Popen(
        [sys.executable, "-m", "server", "run", "--port", "0"],
        cwd=tmp_path,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    ) as server:
        try:
            assert server.stdout is not None
            yield [server.stdout.readline().strip() for _ in range(5)], own["certificate"]
        finally:
            server.send_signal(signal.SIGTERM)
            server.wait(60)


def test_video_goes_through_tls_and_a_stalled_viewer_is_disconnected(
    under_tls: tuple[list[str], Path],
) -> None:
    (_, address, link, fingerprint, _), certificate = under_tls
    found = re.fullmatch(r"Open https://127\.0\.0\.1:(\d+)/", address)
    assert found is not None
    port, context = int(found[1]), ssl.create_default_context(cafile=str(certificate))
    der = ssl.PEM_cert_to_DER_cert(certificate.read_text())
    assert fingerprint.replace(":", "").endswith(hashlib.sha256(der).hexdigest().upper())
    with _line(port, context) as line:
        answer = _requested(line, port, link.partition("#")[2])
    assert "strict-transport-security: max-age=31536000" in answer.lower()
    cookie = re.search(rf"(__Host-coaxial-{port}=[^;]+); .*; Secure\r", answer)
    assert cookie is not None
    headers = {"Cookie": cookie[1], "Origin": f"https://localhost:{port}"}
    address = f"wss://localhost:{port}/ws/view"
    with (
        connect(address, ssl=context, additional_headers=headers, proxy=None, max_size=None) as view,
        _line(port, context) as stalled,
    ):
        stalled.sendall(
            f"GET /video/main.mjpg HTTP/1.1\r\nHost: localhost:{port}\r\nCookie: {cookie[1]}\r\n\r\n".encode()
        )
        sizes: list[int] = []
        while sum(size > 100_000 for size in sizes) < 3:
            view.send('{"next": true}')
            sizes.append(len(view.recv(timeout=60)))
        # It reads nothing; the buffered data is read after the server has closed the connection.
        while 'coaxial_viewer_let_go_total{kind="mjpeg"} 1.0' not in _metrics(port, context, cookie[1]):
            view.send('{"next": true}')
            view.recv(timeout=60)
        with contextlib.suppress(ConnectionError, ssl.SSLError):
            while stalled.recv(1 << 20):
                pass


def _metrics(port: int, context: ssl.SSLContext, cookie: str) -> str:
    requested = urllib.request.Request(f"https://localhost:{port}/metrics", headers={"Cookie": cookie})
    with urllib.request.urlopen(requested, context=context, timeout=60) as answer:  # noqa: S310  our own address
        reported: bytes = answer.read()
        return reported.decode()


def _requested(line: ssl.SSLSocket, port: int, invitation: str) -> str:
    body = json.dumps({"invitation": invitation})
    line.sendall(
        f"POST /api/session HTTP/1.1\r\nHost: localhost:{port}\r\nContent-Type: application/json\r\n"
        f"Connection: close\r\nContent-Length: {len(body)}\r\n\r\n{body}".encode()
    )
    return b"".join(iter(lambda: line.recv(65536), b"")).decode()


@contextlib.contextmanager
def _line(port: int, context: ssl.SSLContext) -> Iterator[ssl.SSLSocket]:
    with (
        socket.create_connection(("127.0.0.1", port), timeout=30) as raw,
        context.wrap_socket(raw, server_hostname="localhost") as line,
    ):
        yield line
