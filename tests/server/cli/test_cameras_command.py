"""`coaxial cameras`, on a machine whose cameras the test makes up."""

import errno
import json
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from server.capture.industrial import Bounds
from server.cli import app
from tests.server.capture.fake_camera import HD, FakeCamera, FakeDevices, modes
from tests.server.capture.fake_industrial import FakeIndustrialCamera, FakeIndustrialCameras


def listed(
    monkeypatch: pytest.MonkeyPatch,
    folder: Path,
    *cameras: FakeCamera,
    words: str = "",
    industrial: FakeIndustrialCameras | None = None,
) -> Result:
    monkeypatch.setattr("server.cli.cameras.system_devices", lambda: FakeDevices(*cameras))
    libraries = () if industrial is None else (industrial,)
    monkeypatch.setattr("server.cli.cameras.installed_libraries", lambda: libraries)
    monkeypatch.chdir(folder)
    return CliRunner().invoke(app, ["cameras", *words.split()])


def test_each_camera_is_reported_with_its_modes_and_the_one_that_is_taken(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    result = listed(
        monkeypatch,
        tmp_path,
        FakeCamera(),
        FakeCamera(path="/dev/video1", captures=False),
        FakeCamera(path="/dev/video2", name="Depth", offered=tuple(modes("Z16", HD, 30)), controls={}),
        FakeCamera(path="/dev/video3", fault=OSError(errno.EACCES, "Permission denied")),
    )
    assert result.exit_code == 0
    assert result.stdout.splitlines() == [
        "/dev/video0  Webcam  (usb-1, uvcvideo)",
        "    YUYV    640 x 480   30, 15 Hz",
        "    YUYV   1280 x 720   10, 5 Hz",
        "    YUYV   1920 x 1080  5 Hz",
        "    MJPG    640 x 480   60, 30 Hz",
        "    MJPG   1280 x 720   60, 30 Hz",
        "    MJPG   1920 x 1080  30, 15 Hz",
        "    MJPG   2560 x 1440  30 Hz",
        "    H264   1920 x 1080  60 Hz",
        "    controls: focus 30, autofocus 1, auto_exposure 3, exposure 250, gain 20, auto_white_balance 1, "
        "white_balance 4000",
        "    Coaxial uses 1920x1080 MJPG at 30 Hz",
        "/dev/video2  Depth  (usb-1, uvcvideo)",
        "    Z16    1280 x 720   30 Hz",
        "    Coaxial cannot decode any of these formats",
        "/dev/video3  cannot be opened: permission denied",
        "    Check the read permission (group 'video') and the cable.",
    ]


def test_the_settings_and_the_calibration_decide_which_mode_is_taken(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "camera.yaml").write_text(
        "matrix: [[900, 0, 640], [0, 900, 360], [0, 0, 1]]\n"
        "distortion: [0, 0, 0, 0]\nsize_wh_px: [1280, 720]\n"
    )
    (tmp_path / "config.yaml").write_text("camera: {calibration: camera.yaml}\n")
    calibrated = listed(monkeypatch, tmp_path, FakeCamera(), words="--json")
    assert json.loads(calibrated.stdout)["cameras"][0]["chosen"] == {
        "fourcc": "MJPG",
        "width_px": 1280,
        "height_px": 720,
        "rate_hz": 30.0,
    }
    (tmp_path / "config.yaml").write_text("camera: {width: 640, height: 480, rate_hz: 60}\n")
    requested = json.loads(listed(monkeypatch, tmp_path, FakeCamera(), words="--json").stdout)["cameras"][0]
    assert (requested["chosen"]["width_px"], requested["chosen"]["rate_hz"]) == (640, 60.0)
    assert requested["controls"]["focus"] == {"value": 30, "min": 0, "max": 10_000}
    assert len(requested["modes"]) == 13


def test_a_machine_without_cameras_is_reported_with_a_remedy(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr("sys.platform", "linux")
    result = listed(monkeypatch, tmp_path)
    assert result.exit_code == 1
    assert result.stdout == ""
    assert result.stderr.startswith("Error: no camera was found on this computer.\nConnect a camera")
    as_json = listed(monkeypatch, tmp_path, words="--json")
    assert as_json.exit_code == 1
    assert json.loads(as_json.stdout) == {"cameras": []}


def test_elsewhere_than_on_linux_the_remedy_is_another(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr("sys.platform", "darwin")
    result = listed(monkeypatch, tmp_path)
    assert result.exit_code == 1
    assert "only be listed on Linux" in result.stderr
    assert "--source 0" in result.stderr


class BusyCamera(FakeIndustrialCamera):
    """Another program uses it."""

    def bounds(self, name: str) -> Bounds | None:
        raise OSError(f"{name} is controlled by another application")


def test_industrial_cameras_are_reported_with_what_they_offer(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    cameras = FakeIndustrialCameras(sn4711=FakeIndustrialCamera(), sn4712=BusyCamera())
    result = listed(monkeypatch, tmp_path, industrial=cameras)
    assert result.exit_code == 0
    assert result.stdout.splitlines() == [
        "basler:4711  Basler a2A1920-160uc  (BaslerUsb)",
        "    Mono8, BayerRG8, BayerRG12",
        "    16 to 1936 x 16 to 1216, 1 to 160 Hz",
        "    triggers: Line1, Line3, Software",
        "    controls: zoom 1, pan 0, tilt 0, auto_exposure 0, exposure 8000, gain 325, auto_white_balance 1",
        "    Coaxial uses 1936x1216 BayerRG8 at 30 Hz",
        "basler:4712  cannot be opened: Width is controlled by another application",
        "    Check that no other program uses it.",
    ]
    (tmp_path / "config.yaml").write_text(
        "camera: {source: 'basler:4711', trigger: line1, width: 1001, height: 800}\n"
    )
    values = json.loads(listed(monkeypatch, tmp_path, industrial=cameras, words="--json").stdout)["cameras"][
        0
    ]
    assert values["path"] == "basler:4711"
    assert values["serial"] == "4711"
    assert values["width_px"] == {"min": 16.0, "max": 1936.0, "step": 8.0}
    assert values["rate_hz"] == {"min": 1.0, "max": 160.0, "step": 0.0}
    # A triggered camera has no rate.
    assert values["chosen"] == {"fourcc": "BayerRG8", "width_px": 1000, "height_px": 800, "rate_hz": 0.0}


def test_a_library_that_is_not_installed_lists_nothing(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    missing = FakeIndustrialCameras(sn4711=FakeIndustrialCamera())
    missing.is_installed = False
    monkeypatch.setattr("sys.platform", "linux")
    result = listed(monkeypatch, tmp_path, industrial=missing)
    assert result.exit_code == 1
    assert "coaxial[basler]" in result.stderr


def test_a_library_that_fails_is_reported_with_its_reason_beside_the_cameras_of_others(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    failing = FakeIndustrialCameras()

    def failed() -> tuple[()]:
        raise OSError("the transport layer cannot be loaded")

    monkeypatch.setattr(failing, "descriptions", failed)
    monkeypatch.setattr("sys.platform", "linux")
    alone = listed(monkeypatch, tmp_path, industrial=failing)
    assert alone.exit_code == 1
    assert alone.stdout.splitlines() == [
        "basler:  its cameras cannot be listed: the transport layer cannot be loaded",
        "    Check that its library and driver are installed completely.",
    ]
    assert listed(monkeypatch, tmp_path, FakeCamera(), industrial=failing).exit_code == 0
