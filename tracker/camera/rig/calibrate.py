"""Calibrate a camera rig, with a report."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from tracker.camera.calibration.report import CalibrationReport, rms
from tracker.camera.calibration.uncertainty import noise_is_correlated, uncertainty
from tracker.camera.detection.view import BoardView
from tracker.camera.model import CameraModel
from tracker.camera.rig.bundle import Bundle, adjusted, places_of, residuals_px, rig_blocks
from tracker.camera.rig.consensus import MAX_OUT_RATIO, MIN_PAIRS, Agreement, agreement
from tracker.errors import CalibrationError, InvalidInput
from tracker.geometry import Array, Camera, Rigid

MAX_POINT_SDS = 5.5
MAX_SHOT_RATIO, GOOD_SHOT_PX = 3.0, 0.2


@dataclass(frozen=True, slots=True, kw_only=True)
class RigCamera:
    """One camera of a rig.

    Attributes:
        name: of the camera.
        model: fitted together with all others.
        camera_from_first: its pose; identity for the first camera.
        covariance: (6, 6) of that [mm, rad], left-multiplied rotation; zero for the first camera.
        reach_95: (6,) half of each 95 % interval, in the same order and units.
        baseline_mm: distance from the first camera.
        baseline_sd_mm: its standard deviation.
        rms_px: over its points.
    """

    name: str
    model: CameraModel
    camera_from_first: Rigid[Camera, Camera]
    covariance: Array
    reach_95: Array
    baseline_mm: float
    baseline_sd_mm: float
    rms_px: float


@dataclass(frozen=True, slots=True, kw_only=True)
class ShotReport:
    """Report of one instant.

    Attributes:
        name: as the caller named it.
        used: the cameras whose views are used.
        reason: reason why a camera's view is not used, or an empty string.
        rms_px: over all its points; NaN where none is used.
    """

    name: str
    used: tuple[str, ...]
    reason: str
    rms_px: float


@dataclass(frozen=True, slots=True, kw_only=True)
class RigReport:
    """A calibrated rig.

    Attributes:
        cameras: in the order given.
        rms_px: over all points of all cameras.
        shared_shots: number of instants used from two or more cameras.
        is_noise_correlated: whether the uncertainty comes from a jackknife over instants.
        shots: in the order given.
    """

    cameras: tuple[RigCamera, ...]
    rms_px: float
    shared_shots: int
    is_noise_correlated: bool
    shots: tuple[ShotReport, ...]


def calibrate_rig(
    shots: Sequence[Mapping[str, BoardView]],
    reports: Mapping[str, CalibrationReport],
    *,
    names: Sequence[str] | None = None,
) -> RigReport:
    """Return the poses of the cameras relative to the first; cameras and board poses are fitted together.

    Args:
        shots: for each instant, by camera, the board as that camera saw it.
        reports: of each camera by itself; the first one is the origin.
        names: of the instants; numbers from 1 if left out.

    Raises:
        CalibrationError: RIG_UNCONNECTED, a camera shares too few views with the others; RIG_VIEWS_DISAGREE,
            views that should be of one instant are not.
        InvalidInput: RIG_TOO_SMALL.
    """
    if len(reports) < 2:
        raise InvalidInput(
            "RIG_TOO_SMALL",
            f"a rig of {len(reports)} camera, needed are at least 2",
            "Give the images of two cameras or more.",
            {"cameras": len(reports)},
        )
    names = tuple(names) if names is not None else tuple(str(n + 1) for n in range(len(shots)))
    agreed = agreement(shots, {name: report.camera for name, report in reports.items()})
    used = [index for index, shot in enumerate(agreed.shots) if shot]
    views = [{name: one.view for name, one in agreed.shots[index].items()} for index in used]
    bundle, out = _reject_outlier_shots(_start(agreed, used, reports), views)
    agreed, used, views = _left(agreed, used, views, out)
    views = _reject_outlier_points(bundle, views)
    bundle = adjusted(bundle, views)
    return _report(bundle, views, used, agreed, names)


def _start(agreed: Agreement, used: Sequence[int], reports: Mapping[str, CalibrationReport]) -> Bundle:
    boards = []
    for index in used:
        name, seen = next(iter(agreed.shots[index].items()))
        boards.append(agreed.camera_from_first[name].inverse @ seen.camera_from_pattern)
    return Bundle(
        models={name: report.camera for name, report in reports.items()},
        camera_from_first=dict(agreed.camera_from_first),
        first_from_pattern=tuple(boards),
    )


def _reject_outlier_shots(
    start: Bundle, views: Sequence[dict[str, BoardView]]
) -> tuple[Bundle, dict[int, str]]:
    """Return the bundle of the inlier instants: reject the worst instant and refit, until the rest agree."""
    retained = list(range(len(views)))
    out: dict[int, str] = {}
    while True:
        some = [views[at] for at in retained]
        first = replace(start, first_from_pattern=tuple(start.first_from_pattern[at] for at in retained))
        bundle = adjusted(first, some)
        typical = [
            float(np.median(np.concatenate([_lengths(bundle, n, *seen) for seen in shot.items()])))
            for n, shot in enumerate(some)
        ]
        worst, usual = int(np.argmax(typical)), float(np.median(typical))
        shared = sum(len(shot) > 1 for shot in some)
        if typical[worst] <= max(MAX_SHOT_RATIO * usual, GOOD_SHOT_PX) or shared <= MIN_PAIRS:
            return bundle, out
        out[retained[worst]] = (
            f"its points lie off by {typical[worst]:.2f} px where others have {usual:.2f} px, allowed "
            f"{max(MAX_SHOT_RATIO * usual, GOOD_SHOT_PX):.2f} px: not of the same instant, or other order"
        )
        del retained[worst]


def _left(
    agreed: Agreement, used: Sequence[int], views: Sequence[dict[str, BoardView]], out: dict[int, str]
) -> tuple[Agreement, list[int], list[dict[str, BoardView]]]:
    """Return the input without the outlier instants."""
    if len(out) > MAX_OUT_RATIO * len(views):
        raise CalibrationError(
            "RIG_VIEWS_DISAGREE",
            f"{len(out)} of {len(views)} instants do not fit to one rig, allowed is a third of them",
            "Check that images of all cameras are of the same instant, and that no camera was moved.",
            {"views": len(views), "disagree": len(out)},
        )
    reasons, shots = list(agreed.reasons), list(agreed.shots)
    for at, reason in out.items():
        reasons[used[at]], shots[used[at]] = reason, {}
    left = [at for at in range(len(views)) if at not in out]
    return (
        replace(agreed, shots=tuple(shots), reasons=tuple(reasons)),
        [used[at] for at in left],
        [views[at] for at in left],
    )


def _lengths(bundle: Bundle, index: int, name: str, view: BoardView) -> Array:
    return np.asarray(np.linalg.norm(residuals_px(bundle, index, name, view), axis=1))


def _reject_outlier_points(bundle: Bundle, views: list[dict[str, BoardView]]) -> list[dict[str, BoardView]]:
    every = [
        (index, name, residuals_px(bundle, index, name, view))
        for index, shot in enumerate(views)
        for name, view in shot.items()
    ]
    sigma_px = 1.4826 * float(np.median(np.abs(np.concatenate([r.ravel() for _, _, r in every])))) + 1e-9
    retained: list[dict[str, BoardView]] = [{} for _ in views]
    for index, name, residual in every:
        near = np.linalg.norm(residual, axis=1) <= MAX_POINT_SDS * sigma_px
        # A view with many outliers is kept complete, so that the RMS of its instant reveals it.
        retained[index][name] = views[index][name].part(near if near.mean() > 0.75 else np.ones_like(near))
    return retained


def _report(
    bundle: Bundle,
    views: Sequence[Mapping[str, BoardView]],
    used: Sequence[int],
    agreed: Agreement,
    names: Sequence[str],
) -> RigReport:
    by_shot = [
        {name: residuals_px(bundle, index, name, view) for name, view in shot.items()}
        for index, shot in enumerate(views)
    ]
    flat_views = [view for shot in views for view in shot.values()]
    flat = [residual for shot in by_shot for residual in shot.values()]
    blocks = rig_blocks(bundle, views)
    is_correlated = noise_is_correlated(flat_views, flat, blocks)
    sure = uncertainty(blocks, is_noise_correlated=is_correlated)
    places = places_of(bundle)
    cameras = []
    for name, model in bundle.models.items():
        own = np.concatenate([shot[name] for shot in by_shot if name in shot])
        place = bundle.camera_from_first[name]
        covariance, reach = np.zeros((6, 6)), np.zeros(6)
        if name in places:
            covariance = sure.covariance[places[name], places[name]]
            reach = sure.reach_95[places[name]]
        cameras.append(_camera(name, model, place, covariance, reach, rms(own)))
    rms_of = {
        index: rms(np.concatenate(list(shot.values()))) for index, shot in zip(used, by_shot, strict=True)
    }
    return RigReport(
        cameras=tuple(cameras),
        rms_px=rms(np.concatenate(flat)),
        shared_shots=sum(len(shot) > 1 for shot in views),
        is_noise_correlated=is_correlated,
        shots=tuple(
            ShotReport(
                name=name,
                used=tuple(agreed.shots[index]),
                reason=agreed.reasons[index],
                rms_px=rms_of.get(index, float("nan")),
            )
            for index, name in enumerate(names)
        ),
    )


def _camera(
    name: str,
    model: CameraModel,
    place: Rigid[Camera, Camera],
    covariance: Array,
    reach: Array,
    rms_px: float,
) -> RigCamera:
    baseline = float(np.linalg.norm(place.translation_mm))
    along = place.translation_mm / max(baseline, 1e-12)
    return RigCamera(
        name=name,
        model=model,
        camera_from_first=place,
        covariance=covariance,
        reach_95=reach,
        baseline_mm=baseline,
        baseline_sd_mm=float(np.sqrt(along @ covariance[:3, :3] @ along)),
        rms_px=rms_px,
    )
