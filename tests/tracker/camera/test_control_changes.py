"""Changes of a camera's controls that invalidate its calibration."""

import pytest

from tracker.camera import CameraControl, ControlChange, control_changes

FOCUS, AUTOFOCUS, ZOOM = CameraControl.FOCUS, CameraControl.AUTOFOCUS, CameraControl.ZOOM
EXPOSURE, GAIN = CameraControl.EXPOSURE, CameraControl.GAIN
CALIBRATED = {FOCUS: 120, AUTOFOCUS: 0, ZOOM: 100, EXPOSURE: 250, GAIN: 20}


@pytest.mark.parametrize(
    ("now", "changed"),
    [
        pytest.param({}, [], id="nothing is known now"),
        pytest.param(CALIBRATED, [], id="all as it was"),
        pytest.param({**CALIBRATED, FOCUS: 135}, [(FOCUS, 120, 135)], id="focus"),
        pytest.param({**CALIBRATED, AUTOFOCUS: 1}, [(AUTOFOCUS, 0, 1)], id="automatic focus is on"),
        pytest.param(
            {**CALIBRATED, AUTOFOCUS: 1, ZOOM: 110, FOCUS: 1},
            [(FOCUS, 120, 1), (ZOOM, 100, 110), (AUTOFOCUS, 0, 1)],
            id="what spoils most comes first",
        ),
        pytest.param({**CALIBRATED, EXPOSURE: 90, GAIN: 0}, [], id="brightness voids nothing"),
        pytest.param({**CALIBRATED, CameraControl.PAN: 5}, [], id="not known at the calibration"),
    ],
)
def test_changes_that_void_a_calibration(
    now: dict[CameraControl, int], changed: list[tuple[CameraControl, int, int]]
) -> None:
    assert control_changes(CALIBRATED, now) == tuple(
        ControlChange(control=control, calibrated=before, now=after) for control, before, after in changed
    )


def test_without_a_calibration_nothing_changes() -> None:
    assert control_changes({}, CALIBRATED) == ()
