"""Automatic registration: detect needles in the image and assign them by plan and ruler."""

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.camera import CameraModel
from tracker.errors import RegistrationError
from tracker.registration.needles.assignment import rank_assignments
from tracker.registration.needles.detection import DetectedNeedle, detect_needles, expected_width_px
from tracker.registration.needles.fit import NeedleFit, register_needles
from tracker.registration.needles.limits import NeedleLimits
from tracker.registration.needles.observation import NeedleObservation
from tracker.registration.needles.planned import PlannedNeedle, reject_poor_geometry
from tracker.registration.needles.view_prior import RulerMeasurement, TouchedPoint, view_prior_from_ruler

MAX_PROPOSALS, MAX_TRIED = 3, 12
# Assignments whose cost exceeds that of the most likely one by more are not proposed.
MAX_COST_DIFFERENCE = 16.0
# Costs assume exact ends of detected needles; in rehearsals their differences are too large by this factor.
COST_SCALE = 3.0
# Two lines whose ends are nearer than this are one needle.
SAME_PX = 4.0
# A mark farther from a detected needle, in stated standard deviations, belongs to another needle.
MAX_MARKED_SD = 3.0


def refine_marked(
    image: npt.ArrayLike, camera: CameraModel, marked: Sequence[NeedleObservation]
) -> tuple[NeedleObservation, ...]:
    """Refine each marked needle by detection; keep the mark if nothing is detected.

    The marked entry is kept, projected onto the detected line.
    """
    out = []
    for mark in marked:
        found = [one.seen for one in detect_needles(image, camera, near=mark)]
        by_distance = {_beside_px(one, mark): one for one in found}
        if not found or min(by_distance) > MAX_MARKED_SD * mark.across_sd_px + 1.0:
            out.append(mark)
            continue
        line = by_distance[min(by_distance)]
        along = (line.head_px - line.entry_px) / line.length_px
        entry = line.entry_px + ((mark.entry_px - line.entry_px) @ along) * along
        out.append(
            dataclasses.replace(
                line, entry_px=entry, along_sd_px=mark.along_sd_px, entry_is_seen=mark.entry_is_seen
            )
        )
    return tuple(out)


def _beside_px(line: NeedleObservation, mark: NeedleObservation) -> float:
    """Return the maximum distance of a mark's ends from a line."""
    along = (line.head_px - line.entry_px) / line.length_px
    beside = np.array([-along[1], along[0]])
    return max(abs(float((end - line.entry_px) @ beside)) for end in (mark.entry_px, mark.head_px))


@dataclass(frozen=True, slots=True, kw_only=True)
class NeedleProposal:
    """One proposed fit; there are several if the assignment is ambiguous.

    The covariance is valid only if the assignment is correct, which a person confirms.

    Attributes:
        fit: the registration with this assignment.
        needles: detected needles, in the plan's order.
        probability_ratio: 0..1, of this assignment among the proposed ones.
        delta_chi2: chi-square of the most likely other assignment minus that of this one; negative if the
            other is more likely, infinite if there is none.
    """

    fit: NeedleFit
    needles: tuple[DetectedNeedle, ...]
    probability_ratio: float
    delta_chi2: float


def propose_needles(
    image: npt.ArrayLike,
    places: Sequence[PlannedNeedle],
    camera: CameraModel,
    measured: RulerMeasurement,
    *,
    touched: tuple[TouchedPoint, ...] = (),
    radius_mm: float = 0.8,
    limits: NeedleLimits | None = None,
) -> tuple[NeedleProposal, ...]:
    """Detect the planned needles in one image, and fit the vertebra to each likely assignment.

    Args:
        image: (h, w, 3) BGR or (h, w) grey, uint8, of the calibrated camera.
        places: three or more planned needles.
        camera: calibrated.
        measured: V, H and azimuth.
        touched: points captured with the tool's tip.
        radius_mm: of the needles' wire.
        limits: of an accepted fit.

    Returns:
        One to three proposals with different assignments, the most likely first.

    Raises:
        InvalidInput: IMAGE_INVALID, RULER_INVALID, VIEW_INVALID.
        RegistrationError: NEEDLES_NOT_FOUND, and the errors of `register_needles` if nothing fits.
    """
    gate = limits or NeedleLimits()
    reject_poor_geometry(places)
    middle = 0.5 * np.array(camera.size_wh_px, dtype=np.float64)
    width = expected_width_px(view_prior_from_ruler(measured, camera, middle), camera, radius_mm=radius_mm)
    found = detect_needles(image, camera, width=width)
    if len(found) < len(places):
        raise RegistrationError(
            "NEEDLES_NOT_FOUND",
            f"{len(found)} needles were found in the image, {len(places)} are planned",
            "Mark each needle by hand, or remove the drill and other instruments from the image.",
            {"found": len(found), "planned": len(places)},
        )
    fits: list[tuple[float, NeedleFit, tuple[DetectedNeedle, ...]]] = []
    rejection: RegistrationError | None = None
    namings = rank_assignments(found, places, camera, measured, touched=touched)
    for cost, naming in namings[:MAX_TRIED]:
        if fits and cost - fits[0][0] > MAX_COST_DIFFERENCE:
            break
        needles = tuple(found[i] for i in naming)
        if any(_is_same(needles, others) for _, _, others in fits):
            continue
        try:
            fit = _fit(needles, places, camera, measured, touched, gate)
        except RegistrationError as rejected:
            rejection = rejection or rejected
            continue
        fits.append((cost, fit, needles))
    if rejection is not None and not fits:
        raise rejection
    return _proposals(fits)


def _fit(
    needles: Sequence[DetectedNeedle],
    places: Sequence[PlannedNeedle],
    camera: CameraModel,
    measured: RulerMeasurement,
    touched: tuple[TouchedPoint, ...],
    gate: NeedleLimits,
) -> NeedleFit:
    seen = [one.seen for one in needles]
    at_px = np.mean([one.entry_px for one in seen], axis=0)
    view = view_prior_from_ruler(measured, camera, at_px, touched=touched)
    # Other orders are separate proposals.
    return register_needles(places, seen, camera, view, limits=gate, order_is_sure=True)


def _proposals(
    fits: Sequence[tuple[float, NeedleFit, tuple[DetectedNeedle, ...]]],
) -> tuple[NeedleProposal, ...]:
    costs = np.array([cost for cost, _, _ in fits])
    probabilities = np.exp(-0.5 * (costs - costs.min()) / COST_SCALE)
    probabilities /= probabilities.sum()
    out = []
    for n, (cost, fit, needles) in enumerate(fits[:MAX_PROPOSALS]):
        delta_chi2 = float(np.delete(costs, n).min(initial=np.inf) - cost)
        out.append(
            NeedleProposal(
                fit=fit,
                needles=needles,
                probability_ratio=float(probabilities[n]),
                delta_chi2=delta_chi2,
            )
        )
    return tuple(out)


def _is_same(needles: Sequence[DetectedNeedle], others: Sequence[DetectedNeedle]) -> bool:
    """Return whether both assign the same lines; one needle may be detected twice with small differences."""
    return all(
        max(_beside_px(one.seen, other.seen), _beside_px(other.seen, one.seen)) < SAME_PX
        for one, other in zip(needles, others, strict=True)
    )
