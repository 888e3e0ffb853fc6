"""Selection of the camera mode to request."""

import pytest

from server.capture.modes import WantedMode, choose_mode
from server.live import CameraMode
from tests.server.capture.fake_camera import FULL_HD, HD, VGA, WEBCAM_MODES, modes

NOTHING = WantedMode()


def mode(fourcc: str, size_wh_px: tuple[int, int], rate_hz: float) -> CameraMode:
    return CameraMode(fourcc=fourcc, size_wh_px=size_wh_px, rate_hz=rate_hz)


@pytest.mark.parametrize(
    ("offered", "wanted", "calibrated", "chosen"),
    [
        pytest.param(WEBCAM_MODES, NOTHING, None, mode("MJPG", FULL_HD, 30), id="full HD needs MJPG"),
        pytest.param(
            modes("YUYV", FULL_HD, 30) + modes("MJPG", FULL_HD, 30),
            NOTHING,
            None,
            mode("YUYV", FULL_HD, 30),
            id="without loss where it is as fast",
        ),
        pytest.param(
            modes("MJPG", FULL_HD, 60, 25),
            NOTHING,
            None,
            mode("MJPG", FULL_HD, 60),
            id="rather more than less",
        ),
        pytest.param(
            modes("YUYV", FULL_HD, 5) + modes("YUYV", HD, 10) + modes("YUYV", VGA, 25),
            NOTHING,
            None,
            mode("YUYV", VGA, 25),
            id="fast before large",
        ),
        pytest.param(
            modes("YUYV", FULL_HD, 5) + modes("YUYV", HD, 10) + modes("YUYV", VGA, 10),
            NOTHING,
            None,
            mode("YUYV", HD, 10),
            id="all slow: the largest of the fastest",
        ),
        pytest.param(
            modes("MJPG", (3840, 2160), 30), NOTHING, None, mode("MJPG", (3840, 2160), 30), id="4K alone"
        ),
        pytest.param(WEBCAM_MODES, NOTHING, HD, mode("MJPG", HD, 30), id="the calibration's size"),
        pytest.param(
            WEBCAM_MODES, NOTHING, (1024, 768), mode("MJPG", FULL_HD, 30), id="calibrated at a size it lacks"
        ),
        pytest.param(
            WEBCAM_MODES,
            WantedMode(size_wh_px=HD),
            FULL_HD,
            mode("MJPG", HD, 30),
            id="settings before calibration",
        ),
        pytest.param(
            WEBCAM_MODES,
            WantedMode(size_wh_px=HD, rate_hz=60),
            None,
            mode("MJPG", HD, 60),
            id="exactly what is asked",
        ),
        pytest.param(
            WEBCAM_MODES,
            WantedMode(size_wh_px=(1600, 1200)),
            None,
            mode("MJPG", FULL_HD, 30),
            id="the nearest size",
        ),
        pytest.param(
            WEBCAM_MODES,
            WantedMode(size_wh_px=FULL_HD, rate_hz=20),
            None,
            mode("MJPG", FULL_HD, 15),
            id="nearest rate",
        ),
        pytest.param(
            WEBCAM_MODES, WantedMode(rate_hz=60), None, mode("MJPG", HD, 60), id="largest at that rate"
        ),
        pytest.param(
            modes("MJPG", FULL_HD, 29.97),
            WantedMode(rate_hz=30),
            None,
            mode("MJPG", FULL_HD, 29.97),
            id="29.97 is 30",
        ),
        pytest.param(modes("H264", FULL_HD, 60), NOTHING, None, None, id="nothing that can be decoded"),
        pytest.param([], NOTHING, None, None, id="nothing is listed"),
        pytest.param(modes("YUYV", VGA, 0), NOTHING, None, mode("YUYV", VGA, 0), id="no rate is listed"),
    ],
)
def test_the_mode_that_is_requested_of_a_camera(
    offered: list[CameraMode],
    wanted: WantedMode,
    calibrated: tuple[int, int] | None,
    chosen: CameraMode | None,
) -> None:
    assert choose_mode(offered, wanted, calibrated_size_wh_px=calibrated) == chosen


def test_a_mode_is_named_for_a_person() -> None:
    assert str(mode("MJPG", FULL_HD, 29.97)) == "1920x1080 MJPG at 29.97 Hz"
    assert str(mode("", VGA, 0.0)) == "640x480"
