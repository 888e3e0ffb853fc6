"""Requested, granted and measured mode."""

import pytest

from server.capture.mode_check import MEASURED_OVER_S, SETTLE_S, ModeCheck
from server.capture.modes import WantedMode
from server.live import CameraMode
from tests.server.capture.fake_camera import FULL_HD, HD

NOTHING = WantedMode()


def mode(rate_hz: float, *, fourcc: str = "MJPG", size_wh_px: tuple[int, int] = FULL_HD) -> CameraMode:
    return CameraMode(fourcc=fourcc, size_wh_px=size_wh_px, rate_hz=rate_hz)


def check(requested: CameraMode | None, granted: CameraMode, *, wanted: WantedMode = NOTHING) -> ModeCheck:
    return ModeCheck("camera 0", wanted=wanted, requested=requested, granted=granted)


def film(
    checked: ModeCheck, rate_hz: float, *, begin_s: float = 0.0, size_wh_px: tuple[int, int] = FULL_HD
) -> float:
    """Images long enough for one measurement; returns the time of the last."""
    images = int((SETTLE_S + 1.5 * MEASURED_OVER_S) * rate_hz) + 1
    for number in range(images):
        checked.take(size_wh_px, begin_s + number / rate_hz)
    return begin_s + images / rate_hz


def code_of(checked: ModeCheck) -> str:
    return "" if checked.problem is None else checked.problem.code


@pytest.mark.parametrize(
    ("wanted", "requested", "granted", "code", "numbers"),
    [
        (NOTHING, mode(30), mode(30), "", []),
        (NOTHING, mode(30), mode(29.97), "", []),
        (
            WantedMode(size_wh_px=(1600, 1200), rate_hz=60),
            mode(30),
            mode(30),
            "CAMERA_MODE_NOT_OFFERED",
            ["1600x1200 at 60 Hz", "1920x1080 MJPG at 30 Hz"],
        ),
        (
            NOTHING,
            mode(30),
            mode(5, fourcc="YUYV"),
            "CAMERA_MODE_NOT_GRANTED",
            ["1920x1080 MJPG at 30 Hz was requested", "1920x1080 YUYV at 5 Hz was granted"],
        ),
        (NOTHING, mode(30), mode(30, size_wh_px=HD), "CAMERA_MODE_NOT_GRANTED", ["1920x1080", "1280x720"]),
        (NOTHING, mode(30), mode(15), "CAMERA_MODE_NOT_GRANTED", ["30 Hz", "15 Hz"]),
        # Offered modes are known on Linux only.
        (
            WantedMode(size_wh_px=FULL_HD),
            None,
            mode(0, fourcc="", size_wh_px=HD),
            "CAMERA_MODE_NOT_GRANTED",
            ["the settings request 1920x1080", "1280x720 was granted"],
        ),
        (NOTHING, None, mode(0, fourcc="", size_wh_px=(0, 0)), "", []),
    ],
)
def test_what_was_granted_is_held_against_what_was_asked(
    wanted: WantedMode, requested: CameraMode | None, granted: CameraMode, code: str, numbers: list[str]
) -> None:
    problem = check(requested, granted, wanted=wanted).problem
    assert ("" if problem is None else problem.code) == code
    for number in numbers:
        assert problem is not None
        assert number in problem.message
        assert problem.remedy


@pytest.mark.parametrize(
    ("rate_hz", "code"),
    [(30.0, ""), (26.0, ""), (25.0, "CAMERA_RATE_DIFFERS"), (15.0, "CAMERA_RATE_DIFFERS")],
)
def test_the_rate_that_really_comes_is_measured(rate_hz: float, code: str) -> None:
    checked = check(mode(30), mode(30))
    film(checked, rate_hz)
    assert code_of(checked) == code


def test_the_sentence_names_what_was_asked_granted_and_measured_and_what_to_do() -> None:
    checked = check(mode(30), mode(30))
    film(checked, 15.0)
    assert checked.problem is not None
    assert checked.problem.message == (
        "camera 0 sends other images than requested: 1920x1080 MJPG at 30 Hz was requested, "
        "1920x1080 MJPG at 30 Hz was granted, images arrive as 1920x1080 at 15.0 Hz"
    )
    assert "more light" in checked.problem.remedy


def test_nothing_is_measured_while_the_camera_settles() -> None:
    checked = check(mode(30), mode(30))
    times_s = [*(number / 5 for number in range(int(5 * SETTLE_S))), *(SETTLE_S + n / 30 for n in range(150))]
    for at_s in times_s:
        checked.take(FULL_HD, at_s)
        assert checked.problem is None


def test_a_restored_rate_ends_it_and_a_wavering_one_is_not_reported_again() -> None:
    checked = check(mode(30), mode(30))
    at_s = film(checked, 15.0)
    reported = checked.problem
    at_s = film(checked, 15.7, begin_s=at_s)
    assert checked.problem is reported
    at_s = film(checked, 26.5, begin_s=at_s)
    assert code_of(checked) == "CAMERA_RATE_DIFFERS"
    film(checked, 29.0, begin_s=at_s)
    assert checked.problem is None


def test_images_of_another_size_than_granted_are_reported_at_once() -> None:
    checked = check(mode(30), mode(30))
    checked.take(HD, 0.0)
    assert checked.problem is not None
    assert "images arrive as 1280x720" in checked.problem.message
    checked.take(FULL_HD, 0.03)
    assert checked.problem is None
