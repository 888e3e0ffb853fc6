"""The software's own fits: needles that it finds in the image, told apart by the plan and the ruler."""

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.camera import CameraModel
from tracker.errors import RegistrationError
from tracker.registration.needles.finding import FoundNeedle, expected_width_px, find_needles
from tracker.registration.needles.fit import NeedleFit, register_needles
from tracker.registration.needles.limits import NeedleLimits
from tracker.registration.needles.naming import likely_namings
from tracker.registration.needles.places import NeedlePlace, reject_poor_places
from tracker.registration.needles.seen import NeedleSeen
from tracker.registration.needles.view import MeasuredView, TouchedPoint, view_from_ruler

MAX_PROPOSALS, MAX_TRIED = 3, 12
# A naming that is so much worse than the likeliest is not worth a person's look.
MAX_WORSE = 16.0
# Costs take all ends for seen where they are found; in rehearsals they are this much too far apart.
TOO_SURE = 3.0
# Two lines that are this near at both ends are one needle.
SAME_PX = 4.0
# A person marks a needle within this many of the stated standard deviations, or has marked another one.
MAX_MARKED_SD = 3.0


def refine_marked(
    image: npt.ArrayLike, camera: CameraModel, marked: Sequence[NeedleSeen]
) -> tuple[NeedleSeen, ...]:
    """Each needle that a person has marked roughly, as the image has it; as marked where nothing is found.

    Where it goes into the bone stays as it was marked, moved onto the needle's line.
    """
    out = []
    for mark in marked:
        found = [one.seen for one in find_needles(image, camera, near=mark)]
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


def _beside_px(line: NeedleSeen, mark: NeedleSeen) -> float:
    """How far the ends of a mark are beside a line at the most."""
    along = (line.head_px - line.entry_px) / line.length_px
    beside = np.array([-along[1], along[0]])
    return max(abs(float((end - line.entry_px) @ beside)) for end in (mark.entry_px, mark.head_px))


@dataclass(frozen=True, slots=True, kw_only=True)
class NeedleProposal:
    """One fit that a person may take or correct; where needles look alike it is one of several.

    The covariance of the fit holds if its naming is right, and that only a person tells.

    Attributes:
        fit: the registration, with each needle's residual, if this is which needle is which.
        needles: as found in the image, in the plan's order.
        probability_ratio: 0..1, how likely this naming is among those that are proposed.
        lead: by how much the likeliest other naming is worse, as a difference of chi squared; negative where
            the other one is likelier, infinite where there is no other.
    """

    fit: NeedleFit
    needles: tuple[FoundNeedle, ...]
    probability_ratio: float
    lead: float


def propose_needles(
    image: npt.ArrayLike,
    places: Sequence[NeedlePlace],
    camera: CameraModel,
    measured: MeasuredView,
    *,
    touched: tuple[TouchedPoint, ...] = (),
    radius_mm: float = 0.8,
    limits: NeedleLimits | None = None,
) -> tuple[NeedleProposal, ...]:
    """Finds the planned needles in one image, and fits the vertebra to each likely way of naming them.

    Args:
        image: (h, w, 3) BGR or (h, w) grey, uint8, of the calibrated camera.
        places: three or more needles of the plan.
        camera: calibrated.
        measured: V, H and azimuth.
        touched: points that the tool's tip was held on.
        radius_mm: of the needles' wire.
        limits: the gate.

    Returns:
        At least one and at most three that name the needles differently, the likeliest first.

    Raises:
        InvalidInput: IMAGE_INVALID, RULER_INVALID, VIEW_INVALID.
        RegistrationError: NEEDLES_NOT_FOUND, and what `register_needles` refuses, where nothing fits.
    """
    gate = limits or NeedleLimits()
    reject_poor_places(places)
    middle = 0.5 * np.array(camera.size_wh_px, dtype=np.float64)
    width = expected_width_px(view_from_ruler(measured, camera, middle), camera, radius_mm=radius_mm)
    found = find_needles(image, camera, width=width)
    if len(found) < len(places):
        raise RegistrationError(
            "NEEDLES_NOT_FOUND",
            f"{len(found)} needles were found in the image, {len(places)} are planned",
            "Mark each needle by hand, or take the drill and other instruments out of their way.",
            {"found": len(found), "planned": len(places)},
        )
    fits: list[tuple[float, NeedleFit, tuple[FoundNeedle, ...]]] = []
    rejection: RegistrationError | None = None
    namings = likely_namings(found, places, camera, measured, touched=touched)
    for cost, naming in namings[:MAX_TRIED]:
        if fits and cost - fits[0][0] > MAX_WORSE:
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
    needles: Sequence[FoundNeedle],
    places: Sequence[NeedlePlace],
    camera: CameraModel,
    measured: MeasuredView,
    touched: tuple[TouchedPoint, ...],
    gate: NeedleLimits,
) -> NeedleFit:
    seen = [one.seen for one in needles]
    at_px = np.mean([one.entry_px for one in seen], axis=0)
    view = view_from_ruler(measured, camera, at_px, touched=touched)
    # Other orders are proposals of their own.
    return register_needles(places, seen, camera, view, limits=gate, order_is_sure=True)


def _proposals(
    fits: Sequence[tuple[float, NeedleFit, tuple[FoundNeedle, ...]]],
) -> tuple[NeedleProposal, ...]:
    costs = np.array([cost for cost, _, _ in fits])
    probabilities = np.exp(-0.5 * (costs - costs.min()) / TOO_SURE)
    probabilities /= probabilities.sum()
    out = []
    for n, (cost, fit, needles) in enumerate(fits[:MAX_PROPOSALS]):
        lead = float(np.delete(costs, n).min(initial=np.inf) - cost)
        out.append(
            NeedleProposal(
                fit=fit,
                needles=needles,
                probability_ratio=float(probabilities[n]),
                lead=lead,
            )
        )
    return tuple(out)


def _is_same(needles: Sequence[FoundNeedle], others: Sequence[FoundNeedle]) -> bool:
    """Whether both name the same lines alike: one needle may have been found twice, a little differently."""
    return all(
        max(_beside_px(one.seen, other.seen), _beside_px(other.seen, one.seen)) < SAME_PX
        for one, other in zip(needles, others, strict=True)
    )
