"""Accuracy certificates through the API: installed, valid for the tools in use, and void after a change."""

from collections.abc import Iterator
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import pytest

from server.camera_file import CameraFile
from server.certificate import (
    Certificate,
    ExaminedSystem,
    Issue,
    PlateFile,
    SigningKey,
    certificate_of,
    certificate_pdf,
    verified,
)
from server.installation import product_version
from tests.procedure.conftest import Server, serving
from tests.tracker.accuracy.test_accuracy_assessment import MEASURED, PLATE, POINTS, SOUND, captures_of
from tracker.accuracy import assess_accuracy
from tracker.camera import CameraControl, ControlChange

NOW = datetime.now(UTC)


def certificate_for(server: Server, *, at: datetime = NOW, marker: str = "drill") -> Certificate:
    """Return a certificate of a rehearsed test, as if it was of the system in use."""
    system = SOUND
    found = assess_accuracy(captures_of(system), PLATE, system.tool, plate_scale=MEASURED)
    setup = server.preparation.setup
    assert setup is not None
    tool = next(one for one in setup.tools.values() if one.marker == "drill")
    plate = PlateFile(
        name="A4", sd_mm=0.1, rulers_mm=100.0, divots={name: list(point) for name, point in POINTS.items()}
    )
    tested = ExaminedSystem(
        camera=CameraFile(model=setup.camera, camera_name="main"),
        marker=marker,
        tool=replace(system.tool, tip_in_marker_mm=tool.marker_from_tool.translation_mm),
        plate=plate,
        scale=MEASURED,
    )
    issue = Issue(
        at=at, valid_days=30, by="ito", software_version=product_version(), audit=None, latency=None
    )
    return certificate_of(found, captures_of(system), tested, issue)


@pytest.fixture
def rehearsing(tmp_path: Path) -> Iterator[Server]:
    """A server whose camera and drill are known from the settings."""
    with serving(tmp_path / "home", {"rehearsal": {"provides_setup": True}}) as server:
        yield server


def tools(server: Server) -> list[dict[str, Any]]:
    return list(server.ask("GET", "/api/certificates", 200)["tools"])


def install(server: Server, content: bytes, status: int = 201) -> Any:  # noqa: ANN401  JSON
    return server.ask("POST", "/api/certificates", status, content=content)


def key_of(server: Server) -> SigningKey:
    return SigningKey(server.store.home.folder)


def test_nothing_is_certified_before_the_first_image(rehearsing: Server) -> None:
    assert tools(rehearsing) == []


def test_a_tool_without_a_certificate_is_not_certified(rehearsing: Server) -> None:
    rehearsing.show(at_s=0.0)
    (drill,) = tools(rehearsing)
    assert (drill["certified"], drill["error_95_mm"]) == (False, None)
    assert drill["problem"]["code"] == "CERTIFICATE_MISSING"


@pytest.mark.parametrize("form", ["json", "pdf"])
def test_an_installed_certificate_is_valid_and_can_be_taken_along(rehearsing: Server, form: str) -> None:
    rehearsing.show(at_s=0.0)
    certificate, key = certificate_for(rehearsing), key_of(rehearsing)
    signed = key.signed_json(certificate.json_values())
    sent = signed if form == "json" else certificate_pdf(certificate, signed, key)
    (drill,) = install(rehearsing, sent)["tools"]
    assert (drill["certified"], drill["problem"]) == (True, None)
    assert drill["error_95_mm"] == certificate.error_95_mm
    assert drill["valid_until"] == certificate.valid_until.isoformat()
    assert tools(rehearsing) == [drill]
    assert rehearsing.door.get("/api/certificates/drill/json").content == signed
    pdf = rehearsing.door.get("/api/certificates/drill/pdf").content
    assert verified(pdf).certificate == certificate
    rehearsing.ask("GET", "/api/certificates/awl/pdf", 404)


@pytest.mark.parametrize(
    ("changed", "code"),
    [
        pytest.param({"software_version": "9.9"}, "CERTIFICATE_SOFTWARE_CHANGED", id="version"),
        pytest.param({"valid_until": NOW - timedelta(days=1)}, "CERTIFICATE_EXPIRED", id="expired"),
        pytest.param({"issued_at": NOW + timedelta(days=2)}, "CERTIFICATE_FROM_THE_FUTURE", id="clock"),
        pytest.param({"camera": {"calibration_sha256": "0" * 64}}, "CERTIFICATE_CAMERA_CHANGED", id="camera"),
        pytest.param({"tool": {"side_mm": 25.1}}, "CERTIFICATE_TOOL_CHANGED", id="side"),
        pytest.param({"tool": {"tip_in_marker_mm": (0.0, -1.0, 0.0)}}, "CERTIFICATE_TOOL_CHANGED", id="tip"),
    ],
)
def test_a_certificate_of_another_system_certifies_nothing(
    rehearsing: Server, changed: dict[str, Any], code: str
) -> None:
    rehearsing.show(at_s=0.0)
    certificate = certificate_for(rehearsing)
    updates = {
        name: getattr(certificate, name).model_copy(update=value) if isinstance(value, dict) else value
        for name, value in changed.items()
    }
    other = certificate.model_copy(update=updates)
    (drill,) = install(rehearsing, key_of(rehearsing).signed_json(other.json_values()))["tools"]
    assert (drill["certified"], drill["problem"]["code"]) == (False, code)


def test_a_tool_is_not_certified_while_the_focus_is_not_that_of_the_calibration(rehearsing: Server) -> None:
    rehearsing.show(at_s=0.0)
    install(rehearsing, key_of(rehearsing).signed_json(certificate_for(rehearsing).json_values()))
    newest = rehearsing.hub.newest
    assert newest is not None
    assert newest.snapshot is not None
    change = ControlChange(control=CameraControl.FOCUS, calibrated=30, now=60)
    motion = replace(newest.snapshot.motion, camera_changes=(change,))
    snapshot = replace(newest.snapshot, motion=motion)
    rehearsing.hub.publish(replace(newest, sequence=newest.sequence + 1, snapshot=snapshot))
    (drill,) = tools(rehearsing)
    assert (drill["certified"], drill["problem"]["code"]) == (False, "CERTIFICATE_NOT_APPLICABLE")


def test_only_certificates_of_this_installation_are_installed(rehearsing: Server, tmp_path: Path) -> None:
    rehearsing.show(at_s=0.0)
    values = certificate_for(rehearsing).json_values()
    forged = SigningKey(tmp_path / "forger").signed_json(values)
    assert install(rehearsing, forged, 422)["code"] == "CERTIFICATE_SIGNER_UNKNOWN"
    signed = key_of(rehearsing).signed_json(values)
    assert install(rehearsing, forged, 422)["code"] == "CERTIFICATE_SIGNER_UNKNOWN"
    assert install(rehearsing, signed.replace(b'"ito"', b'"eve"'), 422)["code"] == "CERTIFICATE_ALTERED"
    assert install(rehearsing, b"{}", 422)["code"] == "CERTIFICATE_UNREADABLE"
    out = {**values, "tool": {**values["tool"], "marker": "../evil"}}
    assert (
        install(rehearsing, key_of(rehearsing).signed_json(out), 422)["code"] == "CERTIFICATE_SIGNER_UNKNOWN"
    )


def test_a_certificate_that_was_damaged_on_the_disk_certifies_nothing(rehearsing: Server) -> None:
    rehearsing.show(at_s=0.0)
    install(rehearsing, key_of(rehearsing).signed_json(certificate_for(rehearsing).json_values()))
    (file,) = (rehearsing.store.home.folder / "certificates").glob("*.json")
    file.write_bytes(file.read_bytes().replace(b'"error_95_mm":0.', b'"error_95_mm":0.0', 1))
    (drill,) = tools(rehearsing)
    assert drill["problem"]["code"] == "CERTIFICATE_MISSING"
