"""Errors of point fits as they are raised are German: their values fill also the templates of phrases."""

import numpy as np
import numpy.typing as npt
import pytest

from server.texts import reason_of_error
from tracker.camera import DotBoard
from tracker.camera.calibration import calibrate
from tracker.camera.detection import BoardNotFound, BoardView, find_board
from tracker.errors import CalibrationError, InvalidInput, NavigationError
from tracker.registration.capture import TipSample, UnseenSample, captured
from tracker.registration.points import PointGate, PointPairs, register_points

FIXED = np.array([[0.0, 0, 0], [40, 3, 0], [5, 30, 8], [22, 18, 35], [-12, 25, 20]])
MOVED = FIXED + np.array([0, 0, 9.0]) * (np.arange(5) == 3)[:, None]


def raised(fixed: npt.NDArray[np.float64], moving: npt.NDArray[np.float64]) -> NavigationError:
    """Return the first error of a registration by these points."""
    try:
        registration = register_points(PointPairs(fixed_mm=fixed, moving_mm=moving))
    except NavigationError as error:
        return error
    return registration.failures(PointGate(), [[10.0, 10.0, 10.0]])[0]


@pytest.mark.parametrize(
    ("code", "german", "fixed", "moving"),
    [
        pytest.param(
            "POINTS_FIT_TOO_LARGE", "die Landmarken passen auf", FIXED, MOVED, id="a landmark that is off"
        ),
        pytest.param(
            "POINTS_UNIT_SUSPECT", "sind offenbar in Metern", FIXED, FIXED / 1000.0, id="tips in metres"
        ),
        pytest.param(
            "POINTS_COINCIDENT",
            "die Punkte 1 und 2 liegen auf dem CT 0,00 mm auseinander",
            FIXED[[0, 0, 2, 3, 4]],
            FIXED,
            id="one landmark twice",
        ),
        pytest.param(
            "POINTS_COLLINEAR",
            "auf dem CT fast auf einer Geraden",
            FIXED[:, :1] * [1.0, 0.0, 0.0],
            FIXED[:, :1] * [1.0, 0.0, 0.0],
            id="landmarks on a line",
        ),
        pytest.param(
            "POINTS_SWAPPED",
            "die Punkte 1 und 2 sind offenbar vertauscht",
            FIXED,
            FIXED[[1, 0, 2, 3, 4]],
            id="two landmarks in the wrong order",
        ),
        pytest.param(
            "POINTS_MIRRORED", "die Punkte sind gespiegelt", FIXED, FIXED * [1.0, 1.0, -1.0], id="mirrored"
        ),
    ],
)
def test_an_error_of_a_point_fit_is_german_as_it_is_raised(
    code: str, german: str, fixed: npt.NDArray[np.float64], moving: npt.NDArray[np.float64]
) -> None:
    error = raised(fixed, moving)
    why = reason_of_error(error)
    assert why.code == code
    assert why.is_translated, error.message
    assert german in why.message["de"]
    assert why.message["en"] == error.message


def test_an_error_with_a_phrase_that_is_not_listed_stays_english() -> None:
    error = raised(FIXED, MOVED)
    message = error.message.replace(str(error.context["misfit"]), "the points are odd")
    odd = type(error)(error.code, message, error.remedy, {**error.context, "misfit": "the points are odd"})
    why = reason_of_error(odd)
    assert not why.is_translated
    assert why.message["de"] == message


def test_a_board_that_is_not_found_has_its_reason_in_german() -> None:
    found = find_board(np.full((480, 640), 128, np.uint8), DotBoard(columns=5, rows=4, pitch_mm=10.0))
    assert isinstance(found, BoardNotFound)
    error = InvalidInput(
        "BOARD_NOT_FOUND",
        f"the board was not found in the image: {found.sentence}",
        "Hold the whole board still and in focus, and try again.",
        {"reason": found.reason.value, "board_problem": found.sentence},
    )
    assert reason_of_error(error).message["de"] == (
        "die Tafel wurde im Bild nicht gefunden: keine Punkte, die ein Raster bilden"
    )


def test_too_few_views_are_german_with_the_fault_of_the_first() -> None:
    board = DotBoard(columns=5, rows=4, pitch_mm=10.0)
    points = board.object_points_mm[:5]
    view = BoardView(ids=np.arange(5), object_points_mm=points, image_points_px=points[:, :2] + 100.0)
    with pytest.raises(CalibrationError) as raised_error:
        calibrate([view], size_wh_px=(640, 480))
    assert reason_of_error(raised_error.value).message["de"] == (
        "0 von 1 Ansichten der Tafel sind verwendbar, nötig mindestens 3 (die erste unbrauchbare: 5 Punkte, "
        "nötig mindestens 6)"
    )


def test_a_capture_of_few_images_is_german_with_rate_reason_and_remedy() -> None:
    # A fast camera, of which every tenth image is tracked.
    times_s = [2.0 * number for number in range(4)]
    unseen = [
        UnseenSample(at_s=at_s, image_number=int(20 * at_s), reason="the camera is not calibrated")
        for at_s in times_s
    ]
    seen = [
        TipSample(
            at_s=at_s, image_number=int(20 * at_s), tip_in_anchor_mm=np.zeros(3), covariance_mm2=np.eye(3)
        )
        for at_s in times_s
    ]
    errors = []
    for samples in (unseen, seen):
        with pytest.raises(NavigationError) as raised_error:
            captured(samples)
        errors.append(reason_of_error(raised_error.value))
    assert errors[0].message["de"] == (
        "die Spitze war in 0 von 4 Bildern bei 0,5 Bildern/s (die Kamera liefert 20,0) bekannt "
        "und in 4 nicht (die Kamera ist nicht kalibriert), nötig in allen"
    )
    assert "bei 0,5 Bildern/s (die Kamera liefert 20,0)" in errors[1].message["de"]
    assert "Der Rechner überspringt Bilder" in errors[1].remedy["de"]
