"""The software's own fit: the needles that it finds in the image, told apart by the plan and the ruler."""

import dataclasses
import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.camera import CameraModel
from tracker.errors import RegistrationError
from tracker.registration.needles.equations import Task
from tracker.registration.needles.finding import FoundNeedle, expected_width_px, find_needles
from tracker.registration.needles.fit import NeedleFit, register_needles
from tracker.registration.needles.limits import NeedleLimits
from tracker.registration.needles.places import NeedlePlace, refuse_poor_places
from tracker.registration.needles.seen import NeedleSeen
from tracker.registration.needles.solutions import linear_cost, nearest_solution
from tracker.registration.needles.view import MeasuredView, TouchedPoint, View, view_from_ruler

MOST_CANDIDATES, MOST_TRIED = 9, 12
# All needles are of one wire: their widths in the image differ by depth and noise alone.
WIDTH_SD_RATIO = 0.15
# A person marks a needle within this many of the stated standard deviations, or has marked another one.
MOST_MARKED_SD = 3.0


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
        if not found or min(by_distance) > MOST_MARKED_SD * mark.across_sd_px + 1.0:
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
    """A fit that a person may take or correct.

    Attributes:
        fit: the registration, with each needle's residual.
        needles: as found in the image, in the plan's order.
        candidates: everything that looked like a needle, the likeliest first.
        lead: by how much the next best choice or order of needles is worse, as a difference of chi squared.
    """

    fit: NeedleFit
    needles: tuple[FoundNeedle, ...]
    candidates: tuple[FoundNeedle, ...]
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
) -> NeedleProposal:
    """Finds the planned needles in one image, and fits the vertebra to them.

    Args:
        image: (h, w, 3) BGR or (h, w) grey, uint8, of the calibrated camera.
        places: three or four needles of the plan.
        camera: calibrated.
        measured: V, H and azimuth.
        touched: points that the tool's tip was held on.
        radius_mm: of the needles' wire.
        limits: the gate.

    Raises:
        InvalidInput: IMAGE_INVALID, RULER_INVALID, VIEW_INVALID.
        RegistrationError: NEEDLES_NOT_FOUND, NEEDLES_UNSURE, and what `register_needles` refuses.
    """
    gate = limits or NeedleLimits()
    refuse_poor_places(places)
    middle = 0.5 * np.array(camera.size_wh_px, dtype=np.float64)
    view = view_from_ruler(measured, camera, middle, touched=touched)
    width = expected_width_px(view, camera, radius_mm=radius_mm)
    found = find_needles(image, camera, width=width)
    candidates = tuple(one for one in found if one.has_head)[:MOST_CANDIDATES]
    if len(candidates) < len(places):
        raise RegistrationError(
            "NEEDLES_NOT_FOUND",
            f"{len(candidates)} needles were found in the image, {len(places)} are planned",
            "Mark each needle by hand, or take the drill and other instruments out of their way.",
            {"found": len(candidates), "planned": len(places)},
        )
    ranked = _ranked(candidates, places, camera, measured, touched)
    chosen = ranked[0][1]
    lead = ranked[1][0] - ranked[0][0] if len(ranked) > 1 else np.inf
    _refuse_unsure([candidates[i] for i in chosen], lead, gate)
    needles = tuple(candidates[i] for i in chosen)
    final = _view(needles, camera, measured, touched)
    fit = register_needles(places, [one.seen for one in needles], camera, final, limits=gate)
    return NeedleProposal(fit=fit, needles=needles, candidates=found, lead=float(lead))


def _refuse_unsure(needles: Sequence[FoundNeedle], lead: float, gate: NeedleLimits) -> None:
    if lead >= gate.least_lead:
        return
    raise RegistrationError(
        "NEEDLES_UNSURE",
        f"two ways of naming what looks like needles fit nearly alike: the second is worse by {lead:.1f} in "
        f"chi squared, needed {gate.least_lead:g}",
        "Mark each needle by hand, under its name.",
        {
            "lead": float(lead),
            "needles_px": [[one.seen.entry_px.tolist(), one.seen.head_px.tolist()] for one in needles],
        },
    )


def _ranked(
    candidates: Sequence[FoundNeedle],
    places: Sequence[NeedlePlace],
    camera: CameraModel,
    measured: MeasuredView,
    touched: tuple[TouchedPoint, ...],
) -> list[tuple[float, tuple[int, ...]]]:
    """Which candidates are which needles: cost and choice, the likeliest first."""
    rough = []
    tasks: dict[tuple[int, ...], Task] = {}
    for choice in itertools.permutations(range(len(candidates)), len(places)):
        needles = [candidates[i] for i in choice]
        view = _view(needles, camera, measured, touched)
        tasks[choice] = Task.of(places, [one.seen for one in needles], camera, view)
        rough.append((linear_cost(tasks[choice]) + _looks_cost(needles), choice))
    rough.sort()
    fine = [
        (nearest_solution(tasks[choice]).cost + _looks_cost([candidates[i] for i in choice]), choice)
        for _, choice in rough[:MOST_TRIED]
    ]
    return sorted(fine)


def _looks_cost(needles: Sequence[FoundNeedle]) -> float:
    """What speaks against these being needles of one kind."""
    widths = np.array([one.seen.width_px for one in needles])
    uneven = (widths / widths.mean() - 1.0) / WIDTH_SD_RATIO
    doubt = -2.0 * np.log([max(one.score_ratio, 1e-3) for one in needles])
    return float((uneven**2).sum() + doubt.sum())


def _view(
    needles: Sequence[FoundNeedle],
    camera: CameraModel,
    measured: MeasuredView,
    touched: tuple[TouchedPoint, ...],
) -> View:
    at_px = np.mean([one.seen.entry_px for one in needles], axis=0)
    return view_from_ruler(measured, camera, at_px, touched=touched)
