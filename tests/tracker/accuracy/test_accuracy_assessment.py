"""Accuracy tests with known truth: figures, faults that are found and named, and what is refused."""

from dataclasses import replace

import numpy as np
import pytest

from tracker.accuracy import (
    AccuracyAssessment,
    DivotCapture,
    DivotPlate,
    Fault,
    FigureName,
    PlateScale,
    assess_accuracy,
)
from tracker.accuracy.plate_fit import fit_plate
from tracker.accuracy.rehearsed import (
    NEAR_AND_FAR,
    RehearsedFaults,
    RehearsedSystem,
    rehearse,
    true_errors_mm,
)
from tracker.errors import CalibrationError, InvalidInput
from tracker.geometry import Array, Camera, Marker, Rigid, rotation_from_vector

POINTS = {
    f"{3 * row + column + 1}": (60.0 * column, 60.0 * row, 0.0) for row in range(3) for column in range(3)
}
PLATE = DivotPlate(name="A4", points_mm=POINTS, sd_mm=0.1)
SLIP_MM = np.array([3.0, 0.0, 0.0])
MEASURED = PlateScale(x_ratio=1.0, y_ratio=1.0, sd_ratio=1e-3)
SOUND = RehearsedSystem(plate=PLATE, seed=3)


def captures_of(system: RehearsedSystem, repetitions: int = 1) -> list[DivotCapture]:
    return [one.at_rest(system.tool) for one in rehearse(system, seed=0, repetitions=repetitions)]


def assessed(system: RehearsedSystem, scale: PlateScale | None = MEASURED) -> AccuracyAssessment:
    return assess_accuracy(captures_of(system), PLATE, system.tool, plate_scale=scale)


def codes(found: AccuracyAssessment) -> list[str]:
    return [one.code for one in found.problems]


def with_faults(faults: RehearsedFaults) -> RehearsedSystem:
    return replace(SOUND, faults=faults)


def test_a_sound_system_is_certified_to_an_error_that_later_captures_keep() -> None:
    found = assessed(SOUND)
    assert codes(found) == []
    lengths: Array = np.linalg.norm(true_errors_mm(SOUND, seed=1, rounds=3)[:, 0], axis=1)
    near, far = (float(np.quantile(one, 0.95)) for one in lengths.reshape(3, 2, -1).transpose(1, 0, 2))
    assert near < far <= found.figures.error_95_mm
    # The bound is no excuse: it is of the size of the error.
    assert found.figures.error_95_mm < 2.0 * far


def test_certified_and_stated_errors_are_those_of_single_images_and_not_of_their_mean() -> None:
    """Averaged over 30 images, jitter would disappear from the certified error, and none need be stated."""
    system = replace(SOUND, jitter_sd_px=0.03, corner_sd_px=0.01, field_sd_px=0.0, images=30)
    rehearsed = rehearse(system, seed=0)
    captures = [one.at_rest(system.tool) for one in rehearsed]
    found = assess_accuracy(captures, PLATE, system.tool, plate_scale=MEASURED)
    residuals = fit_plate(PLATE, captures).residuals_mm
    far = [
        float(np.linalg.norm(tip - capture.tip_in_camera_mm + residual))
        for one, capture, residual in zip(rehearsed, captures, residuals, strict=True)
        for tip in one.poses.points_mm(system.tool.tip_in_marker_mm)
        if one.placement == "far"
    ]
    assert np.quantile(far, 0.95) <= found.figures.error_95_mm
    assert "ACCURACY_STATED_TOO_SMALL" not in codes(found)
    of_mean = [replace(one, covariance_mm2=0.001 * np.eye(3)) for one in captures]
    bold = assess_accuracy(of_mean, PLATE, system.tool, plate_scale=MEASURED)
    assert "ACCURACY_STATED_TOO_SMALL" in codes(bold)


@pytest.mark.parametrize(
    ("faults", "scale", "first", "fault"),
    [
        pytest.param(
            RehearsedFaults(print_scale_ratio=-0.01),
            None,
            "ACCURACY_PRINT_SCALE",
            Fault.SCALE,
            id="a plate printed 1 % too small, not measured",
        ),
        pytest.param(
            RehearsedFaults(print_scale_ratio=-0.01),
            MEASURED,
            "ACCURACY_MARKER_SCALE",
            Fault.SCALE,
            id="the same with rulers that are true: the marker's side is wrong",
        ),
        pytest.param(
            RehearsedFaults(tip_offset_mm=1.0),
            MEASURED,
            "ACCURACY_TIP_OFFSET",
            Fault.TIP_OFFSET,
            id="a tip 1 mm off",
        ),
        pytest.param(
            RehearsedFaults(focal_error_ratio=0.02),
            MEASURED,
            "ACCURACY_FOCAL_LENGTH",
            Fault.FOCAL_LENGTH,
            id="a focal length 2 % too large",
        ),
        pytest.param(
            RehearsedFaults(focal_error_ratio=-0.02),
            MEASURED,
            "ACCURACY_FOCAL_LENGTH",
            Fault.FOCAL_LENGTH,
            id="a focal length 2 % too small",
        ),
    ],
)
def test_a_fault_is_found_named_and_refused(
    faults: RehearsedFaults, scale: PlateScale | None, first: str, fault: Fault
) -> None:
    system = with_faults(faults)
    found = assessed(system, scale)
    assert codes(found)[0] == first
    assert [one.fault for one in found.diagnosis.found] == [fault]
    truth = {
        Fault.SCALE: [faults.print_scale_ratio],
        Fault.FOCAL_LENGTH: [faults.focal_error_ratio],
        Fault.TIP_OFFSET: system.tool.tip_in_marker_mm - np.array(system.tip_in_marker_mm),
    }[fault]
    estimate = found.diagnosis.of(fault)
    assert np.abs(np.array(estimate.value) - truth).max() < 3.0 * estimate.sd


def test_a_plate_measured_too_small_is_refused_by_its_rulers() -> None:
    system = with_faults(RehearsedFaults(print_scale_ratio=-0.01))
    found = assessed(system, PlateScale(x_ratio=0.99, y_ratio=0.99, sd_ratio=1e-3))
    assert codes(found) == ["ACCURACY_PLATE_SCALE"]
    assert "1.00% too small" in found.problems[0].message
    # Corrected by its rulers, the plate fits.
    assert not found.diagnosis.found


def test_a_frontal_plate_and_a_tool_that_is_never_turned_exclude_neither_focal_length_nor_tip() -> None:
    """Depth and orientation are constant there, so both faults only shift the plate."""
    random = np.random.default_rng(0)
    rotation = rotation_from_vector([2.6, 0.0, 0.3])
    tip = np.array(SOUND.tip_in_marker_mm)
    captures = []
    for name, point in 4 * list(POINTS.items()):
        at = np.array(point) + [-60.0, -60.0, 500.0] + random.normal(size=3) * 0.1
        pose: Rigid[Camera, Marker] = Rigid(rotation=rotation, translation_mm=at - rotation @ tip)
        captures.append(
            DivotCapture(
                divot=name,
                placement="only",
                posture="upright",
                camera_from_marker=pose,
                tip_in_camera_mm=at,
                image_tip_in_camera_mm=at,
                covariance_mm2=0.1**2 * np.eye(3),
                jitter_covariance_mm2=0.01**2 * np.eye(3),
                jitter_deg=0.01,
                images=8,
            )
        )
    found = assess_accuracy(captures, PLATE, SOUND.tool, plate_scale=MEASURED)
    assert found.diagnosis.of(Fault.FOCAL_LENGTH).sd > 0.005
    assert found.diagnosis.of(Fault.TIP_OFFSET).sd > 10.0
    assert found.diagnosis.of(Fault.SCALE).sd < 0.002
    assert codes(found) == ["ACCURACY_FAULT_NOT_EXCLUDED"] * 2


def test_errors_that_are_stated_too_small_are_refused() -> None:
    bold = [
        replace(one, covariance_mm2=None if one.covariance_mm2 is None else one.covariance_mm2 / 100.0)
        for one in captures_of(SOUND)
    ]
    plate = replace(PLATE, sd_mm=0.02)
    found = assess_accuracy(bold, plate, SOUND.tool, plate_scale=MEASURED)
    assert "ACCURACY_STATED_TOO_SMALL" in codes(found)


def test_captures_without_covariance_are_assessed_and_not_certified() -> None:
    silent = [replace(one, covariance_mm2=None) for one in captures_of(SOUND)]
    found = assess_accuracy(silent, PLATE, SOUND.tool, plate_scale=MEASURED)
    assert codes(found) == ["ACCURACY_COVARIANCE_MISSING"]
    assert found.figures.get(FigureName.INSIDE_STATED) is None
    assert not found.diagnosis.found


def test_one_wrong_name_of_a_divot_is_named_and_not_averaged() -> None:
    captures = captures_of(SOUND)
    captures[7] = replace(captures[7], divot="9")
    with pytest.raises(InvalidInput, match="the nearest divot is '3'") as raised:
        assess_accuracy(captures, PLATE, SOUND.tool, plate_scale=MEASURED)
    assert raised.value.code == "ACCURACY_WRONG_DIVOT"


def test_the_same_poses_as_two_captures_are_rejected() -> None:
    captures = captures_of(SOUND)
    captures[1] = replace(captures[0], posture="tilted")
    with pytest.raises(InvalidInput, match=r"upright and .* tilted have the same") as raised:
        assess_accuracy(captures, PLATE, SOUND.tool, plate_scale=MEASURED)
    assert raised.value.code == "ACCURACY_CAPTURE_REPEATED"


def test_few_captures_are_refused_before_any_figure() -> None:
    captures = [one for one in captures_of(SOUND) if one.posture == "upright"]
    with pytest.raises(InvalidInput) as raised:
        assess_accuracy(captures, PLATE, SOUND.tool, plate_scale=MEASURED)
    assert raised.value.code == "ACCURACY_TOO_FEW_CAPTURES"


def test_repeatability_is_a_figure_only_with_repetitions() -> None:
    assert assessed(SOUND).figures.get(FigureName.REPEATABILITY) is None
    found = assess_accuracy(captures_of(SOUND, 2), PLATE, SOUND.tool, plate_scale=MEASURED)
    figure = found.figures.get(FigureName.REPEATABILITY)
    assert figure is not None
    assert figure.samples == 2 * len(POINTS) * len(NEAR_AND_FAR)


def test_a_slip_counts_and_makes_the_certified_error_larger() -> None:
    """No capture is dropped as an outlier."""
    captures = captures_of(SOUND)
    slipped = replace(captures[20], tip_in_camera_mm=captures[20].tip_in_camera_mm + SLIP_MM)
    before = assess_accuracy(captures, PLATE, SOUND.tool, plate_scale=MEASURED)
    after = assess_accuracy(
        [*captures[:20], slipped, *captures[21:]], PLATE, SOUND.tool, plate_scale=MEASURED
    )
    assert after.captures == before.captures
    assert after.figures.error_95_mm > 1.3 * before.figures.error_95_mm


def test_a_tip_that_moves_within_a_capture_is_rejected() -> None:
    capture = rehearse(SOUND, seed=0)[0]
    moved = capture.poses.translations_mm + np.linspace(0.0, 6.0, len(capture.poses))[:, None] * [
        1.0,
        0.0,
        0.0,
    ]
    with pytest.raises(CalibrationError, match="divot 1, placement near, upright") as raised:
        replace(capture, poses=replace(capture.poses, translations_mm=moved)).at_rest(SOUND.tool)
    assert raised.value.code == "ACCURACY_CAPTURE_MOVED"


@pytest.mark.parametrize(
    ("points", "reason"),
    [
        pytest.param({"a": (0, 0, 0), "b": (50, 0, 0), "c": (0, 50, 0)}, "3 divots", id="three"),
        pytest.param({str(n): (20.0 * n, 0.0, 0.0) for n in range(5)}, "on one line", id="on a line"),
        pytest.param({**POINTS, "10": (1.0, 0.0, 0.0)}, "1.0 mm apart", id="two in one place"),
        pytest.param({**POINTS, "10": (float("nan"), 0.0, 0.0)}, "not finite", id="no number"),
    ],
)
def test_a_plate_that_is_no_reference_is_rejected(
    points: dict[str, tuple[float, float, float]], reason: str
) -> None:
    with pytest.raises(InvalidInput, match=reason):
        DivotPlate(name="odd", points_mm=points)


def test_the_stated_error_of_the_tip_counts_once_for_all_captures() -> None:
    """A tip calibrated to 0.4 mm moves all captures as far as the tool turns, and that is stated."""
    system = replace(SOUND, tip_sd_mm=0.4)
    inside = assessed(system).figures.get(FigureName.INSIDE_STATED)
    exact = replace(system.tool, tip_covariance_mm2=np.zeros((3, 3)))
    bold = assess_accuracy(captures_of(system), PLATE, exact, plate_scale=MEASURED)
    unstated = bold.figures.get(FigureName.INSIDE_STATED)
    assert inside is not None
    assert unstated is not None
    assert unstated.estimate.value < inside.estimate.value - 0.05
    assert inside.estimate.high > 0.95
