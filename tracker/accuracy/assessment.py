"""Assessment of an accuracy test: figures, faults, and the reasons why no accuracy can be certified."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tracker.accuracy.capture import DivotCapture
from tracker.accuracy.faults import Diagnosis, Fault, FaultEstimate, diagnose
from tracker.accuracy.figures import FigureName, Figures, figures_of
from tracker.accuracy.marker_geometry import TrackedTool
from tracker.accuracy.plate import DivotPlate
from tracker.accuracy.plate_fit import POSE_PARAMETERS, fit_plate
from tracker.errors import CalibrationError, InvalidInput
from tracker.geometry import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class AccuracyLimits:
    """Requirements of a certificate.

    Attributes:
        max_error_95_mm: largest error that is certified, see `Figures.error_95_mm`.
        max_scale_error_ratio: upper limit of the scale error of plate and marker.
        max_tip_offset_mm: upper limit of the offset of the tip.
        max_focal_error_ratio: upper limit of the relative error of the focal length.
        min_captures: number of captures.
        min_freedom: degrees of freedom, in vectors, between divots and within them.
    """

    max_error_95_mm: float = 2.0
    max_scale_error_ratio: float = 0.006
    max_tip_offset_mm: float = 0.8
    max_focal_error_ratio: float = 0.01
    min_captures: int = 24
    min_freedom: float = 6.0


@dataclass(frozen=True, slots=True, kw_only=True)
class PlateScale:
    """Measured by nominal length of the printed rulers, or 1 for a plate with measured divots.

    Attributes:
        x_ratio, y_ratio: along both axes of the plate.
        sd_ratio: standard deviation of these ratios.
    """

    x_ratio: float
    y_ratio: float
    sd_ratio: float


@dataclass(frozen=True, slots=True, kw_only=True)
class AccuracyAssessment:
    """Result of an accuracy test.

    Attributes:
        figures: figures after ASTM F2554.
        diagnosis: estimated faults.
        problems: reasons against a certificate; empty where it can be issued.
        volume_min_mm, volume_max_mm: (3,), box of the captured tips in the camera's frame.
        placements, divots, captures: numbers of them.
    """

    figures: Figures
    diagnosis: Diagnosis
    problems: tuple[CalibrationError, ...]
    volume_min_mm: Array
    volume_max_mm: Array
    placements: int
    divots: int
    captures: int


def assess_accuracy(
    captures: Sequence[DivotCapture],
    plate: DivotPlate,
    tool: TrackedTool,
    *,
    plate_scale: PlateScale | None,
    limits: AccuracyLimits | None = None,
) -> AccuracyAssessment:
    """Return figures, faults and problems of a test.

    `plate_scale` is None for a plate that nobody measured. Its captures are assessed, and not certified: a
    reference that was not measured is none.

    Raises:
        InvalidInput: ACCURACY_CAPTURE_REPEATED, ACCURACY_TOO_FEW_CAPTURES, or as `fit_plate`.
    """
    limits = limits or AccuracyLimits()
    _reject_repeated(captures)
    _reject_too_few(captures, limits)
    scale = plate_scale or PlateScale(x_ratio=1.0, y_ratio=1.0, sd_ratio=0.0)
    true_plate = plate.scaled(scale.x_ratio, scale.y_ratio)
    fit = fit_plate(true_plate, captures)
    figures = figures_of(fit, true_plate, tool)
    diagnosis = diagnose(fit, true_plate, tool, plate_scale_sd_ratio=scale.sd_ratio)
    tips = np.array([one.tip_in_camera_mm for one in captures])
    problems = [
        *_fault_problems(diagnosis, limits, is_measured=plate_scale is not None),
        *plate_problems(plate_scale, limits),
        *_figure_problems(figures, limits),
    ]
    return AccuracyAssessment(
        figures=figures,
        diagnosis=diagnosis,
        problems=tuple(problems),
        volume_min_mm=tips.min(axis=0),
        volume_max_mm=tips.max(axis=0),
        placements=len(fit.poses),
        divots=len({one.divot for one in captures}),
        captures=len(captures),
    )


def _reject_repeated(captures: Sequence[DivotCapture]) -> None:
    """Reject the same poses as two captures: they count as two samples, and have no scatter between them."""
    earlier: dict[bytes, DivotCapture] = {}
    for one in captures:
        pose = one.camera_from_marker.rotation.tobytes() + one.camera_from_marker.translation_mm.tobytes()
        other = earlier.setdefault(pose, one)
        if other is not one:
            raise InvalidInput(
                "ACCURACY_CAPTURE_REPEATED",
                f"the captures {other.title} and {one.title} have the same poses",
                "Record poses of its own for each capture, and name them in the captures file.",
                {"capture": other.title, "again": one.title},
            )


def _reject_too_few(captures: Sequence[DivotCapture], limits: AccuracyLimits) -> None:
    groups = {one.group for one in captures}
    placements = {one.placement for one in captures}
    between = len(groups) - POSE_PARAMETERS / 3.0 * len(placements)
    within = len(captures) - len(groups)
    if len(captures) >= limits.min_captures and min(between, within) >= limits.min_freedom:
        return
    raise InvalidInput(
        "ACCURACY_TOO_FEW_CAPTURES",
        f"{len(captures)} captures of {len(groups)} divots in {len(placements)} placements leave {between:g} "
        f"degrees of freedom between divots and {within} within them, needed {limits.min_captures} captures "
        f"and {limits.min_freedom:g} degrees of freedom",
        "Capture more divots in each placement, and each divot upright, tilted and turned.",
        {
            "captures": len(captures),
            "divots": len(groups),
            "placements": len(placements),
            "between": between,
            "within": within,
            "needed": limits.min_captures,
            "needed_freedom": limits.min_freedom,
        },
    )


def plate_problems(scale: PlateScale | None, limits: AccuracyLimits | None = None) -> list[CalibrationError]:
    """Return the reasons why nothing is certified with a plate of this scale, known before any capture."""
    limits = limits or AccuracyLimits()
    if scale is None:
        return [
            CalibrationError(
                "ACCURACY_PLATE_UNMEASURED",
                "the rulers of the printed plate were not measured, so that its scale is unknown",
                "Measure both rulers of the plate with calipers or a steel ruler, and state their lengths.",
            )
        ]
    off = max(scale.x_ratio - 1.0, scale.y_ratio - 1.0, key=abs)
    if abs(off) <= limits.max_scale_error_ratio:
        return []
    way = "small" if off < 0.0 else "large"
    return [
        CalibrationError(
            "ACCURACY_PLATE_SCALE",
            f"the plate is printed {abs(off):.2%} too {way} by its rulers, allowed "
            f"{limits.max_scale_error_ratio:.2%}",
            "Print the plate at 100 %, without fitting it to the page, and measure its rulers again.",
            {"size_ratio": abs(off), "wrong_way": way, "allowed_ratio": limits.max_scale_error_ratio},
        )
    ]


def _fault_problems(
    diagnosis: Diagnosis, limits: AccuracyLimits, *, is_measured: bool
) -> list[CalibrationError]:
    allowed = {
        Fault.SCALE: limits.max_scale_error_ratio,
        Fault.TIP_OFFSET: limits.max_tip_offset_mm,
        Fault.FOCAL_LENGTH: limits.max_focal_error_ratio,
    }
    over = [one for one in diagnosis.estimates if one.max_size > allowed[one.fault]]
    indistinct = [one.fault for one in over if one.fault in diagnosis.indistinct]
    if len(indistinct) > 1:
        names = " or ".join(_NAMES[fault] for fault in indistinct)
        return [
            CalibrationError(
                "ACCURACY_FAULT_AMBIGUOUS",
                f"the residuals show a systematic fault that these captures do not tell apart: {names}",
                "Capture the plate at two distances, tilted to the camera, with the tool in all postures.",
                {"faults": names},
            )
        ]
    over.sort(key=lambda one: (not one.is_found, one.p))
    return [_fault_problem(one, allowed[one.fault], is_measured=is_measured) for one in over]


_NAMES = {
    Fault.SCALE: "a wrong scale of plate or marker",
    Fault.TIP_OFFSET: "a wrong tip",
    Fault.FOCAL_LENGTH: "a wrong focal length",
}
_UNKNOWN_REMEDY = {
    Fault.SCALE: "Capture divots that are farther apart, or measure the rulers of the plate more exactly.",
    Fault.TIP_OFFSET: "Tilt the tool farther to all sides and turn it about its axis in the divots.",
    Fault.FOCAL_LENGTH: "Capture the plate at two distances, tilted to the camera by 30 degrees and more.",
}


def _fault_problem(one: FaultEstimate, allowed: float, *, is_measured: bool) -> CalibrationError:
    if not one.is_found:
        is_length = one.fault is Fault.TIP_OFFSET
        size = f"{one.max_size:.2f} mm" if is_length else f"{one.max_size:.2%}"
        limit = f"{allowed:.2f} mm" if is_length else f"{allowed:.2%}"
        return CalibrationError(
            "ACCURACY_FAULT_NOT_EXCLUDED",
            f"{_NAMES[one.fault]} of up to {size} is not excluded by these captures, allowed {limit}",
            _UNKNOWN_REMEDY[one.fault],
            {"fault_phrase": _NAMES[one.fault], "size": size, "allowed": limit},
        )
    if one.fault is Fault.TIP_OFFSET:
        return CalibrationError(
            "ACCURACY_TIP_OFFSET",
            f"the tip of the tool is {one.size:.2f} mm (sd {one.sd:.2f}) from where it is stated, allowed "
            f"{allowed:.2f} mm with its uncertainty",
            "Check that neither the tool nor its marker is bent or loose, and calibrate the tip again.",
            {"size_mm": one.size, "sd_mm": one.sd, "allowed_mm": allowed},
        )
    way = "small" if one.value[0] < 0.0 else "large"
    context = {"size_ratio": one.size, "sd_ratio": one.sd, "allowed_ratio": allowed, "wrong_way": way}
    if one.fault is Fault.FOCAL_LENGTH:
        return CalibrationError(
            "ACCURACY_FOCAL_LENGTH",
            f"the focal length of the camera is stated {one.size:.2%} (sd {one.sd:.2%}) too {way}, allowed "
            f"{allowed:.2%} with its uncertainty",
            "Calibrate the camera again with the zoom and focus of the procedure, and lock both.",
            context,
        )
    if is_measured:
        return CalibrationError(
            "ACCURACY_MARKER_SCALE",
            f"distances measure {one.size:.2%} (sd {one.sd:.2%}) too {way} on a plate whose rulers were "
            f"measured, allowed {allowed:.2%} with its uncertainty: the stated side of the marker is too "
            f"{way}",
            "Measure the black square of the tool's marker, correct side_mm, and calibrate the tip again.",
            context,
        )
    return CalibrationError(
        "ACCURACY_PRINT_SCALE",
        f"the plate is printed {one.size:.2%} (sd {one.sd:.2%}) too {way}, or the stated side of the marker "
        f"is too {way}, allowed {allowed:.2%} with its uncertainty",
        "Measure both rulers of the plate. If they are correct, measure the black square of the marker.",
        context,
    )


def _figure_problems(figures: Figures, limits: AccuracyLimits) -> list[CalibrationError]:
    problems = []
    error_mm = figures.error_95_mm
    if not error_mm <= limits.max_error_95_mm:
        problems.append(
            CalibrationError(
                "ACCURACY_ERROR_TOO_LARGE",
                f"95 % of the tips are within {error_mm:.2f} mm, allowed {limits.max_error_95_mm:.2f} mm",
                "Bring the camera nearer, improve the light, and calibrate camera and tip again.",
                {"error_95_mm": error_mm, "allowed_mm": limits.max_error_95_mm},
            )
        )
    inside = figures.get(FigureName.INSIDE_STATED)
    if inside is None:
        problems.append(
            CalibrationError(
                "ACCURACY_COVARIANCE_MISSING",
                "the captured poses state no covariance, so that the stated errors cannot be checked",
                "Record the captures with 'coaxial track --json'.",
            )
        )
    elif inside.estimate.high < 0.95:
        problems.append(
            CalibrationError(
                "ACCURACY_STATED_TOO_SMALL",
                f"only {inside.estimate.value:.0%} of the tips are inside their stated 95 % region (95 % "
                f"interval {inside.estimate.low:.0%} to {inside.estimate.high:.0%})",
                "Do not rely on the stated errors of this system; calibrate camera and tip again.",
                {
                    "inside_ratio": inside.estimate.value,
                    "low_ratio": inside.estimate.low,
                    "high_ratio": inside.estimate.high,
                },
            )
        )
    return problems
