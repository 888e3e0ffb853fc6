"""Three needles in one image become the registration, with what it cannot know beside it.

Image, ruler and touched points are one fit, each with its own spread. Three needles in one image leave
depth to the ruler, and bone often hides where they go in: P3P took the visible rim for the entry. So the
rim is an entry with a spread (3 mm, sd 4), unless a person marks the entry itself. Depth is never known
from needles alone.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import special

from tracker.camera import CameraModel
from tracker.errors import InvalidInput, RegistrationError
from tracker.geometry import Array, Rigid, angle_between_deg, vector_from_rotation
from tracker.registration.needles.equations import Task
from tracker.registration.needles.limits import NeedleLimits
from tracker.registration.needles.order import other_orders, reject_swapped
from tracker.registration.needles.places import NeedlePlace, reject_poor_places
from tracker.registration.needles.seen import NeedleSeen
from tracker.registration.needles.solutions import Solution, solutions
from tracker.registration.needles.sureness import Sureness, sureness_of
from tracker.registration.needles.view import View
from tracker.registration.record import AnchoredTo, Method, Registration


@dataclass(frozen=True, slots=True, kw_only=True)
class NeedleResidual:
    """How one needle meets its place.

    Attributes:
        name: of the needle.
        offset_px: from its place to its line in the image, or to its entry where that is seen.
        offset_mm: the same on the patient, at the needle's distance.
        lean_deg: from its planned direction, in the image; a needle may lean as it likes.
    """

    name: str
    offset_px: float
    offset_mm: float
    lean_deg: float


@dataclass(frozen=True, slots=True, kw_only=True)
class NeedleFit:
    """A registration by needles that has passed its gate.

    Attributes:
        registration: anchored to the camera.
        residuals: of each needle, in the plan's order.
        chi2: sum of squared residuals, each of sd 1, of needles, ruler and touched points.
        freedom: what chi squared should be, about.
        sureness: which directions are known, and from what.
        rivals: how many other poses there are that are less likely.
        order_lead: how much worse the needles fit in any other order, as a difference of chi squared; where
            it is low, the image does not show which needle is which, and only the marking tells. Infinite
            for more than four needles.
    """

    registration: Registration
    residuals: tuple[NeedleResidual, ...]
    chi2: float
    freedom: int
    sureness: Sureness
    rivals: int
    order_lead: float


def register_needles(
    places: Sequence[NeedlePlace],
    seen: Sequence[NeedleSeen],
    camera: CameraModel,
    view: View,
    *,
    limits: NeedleLimits | None = None,
    order_is_sure: bool = False,
) -> NeedleFit:
    """The vertebra's pose in the camera, fitted to the needles, the measured view and touched points.

    One image of three needles knows well where they are across the view and how they are turned in the image;
    depth and tilt it hardly knows, and there the measured view or touched points must help. The covariance
    says how much of each is left open, the view's own errors included.

    Args:
        places: three or more needles of the plan.
        seen: the same needles in the image, in the same order.
        camera: calibrated.
        view: tilt and distance of the camera, measured, and touched points.
        limits: the gate.
        order_is_sure: whether the needles cannot have been marked for one another, as under an overlay.

    Raises:
        InvalidInput: NEEDLES_UNPAIRED.
        RegistrationError: NEEDLES_TOO_FEW, NEEDLES_TOO_CLOSE, NEEDLES_COLLINEAR, NEEDLES_SWAPPED,
            NEEDLES_DISAGREE, NEEDLE_OFF_ITS_PLACE, NEEDLES_AMBIGUOUS.
    """
    gate = limits or NeedleLimits()
    _reject_unpaired(places, seen)
    reject_poor_places(places)
    found = solutions(Task.of(places, seen, camera, view))
    best = found[0]
    residuals = _residuals(best)
    freedom = _freedom(best)
    orders = other_orders(places, seen, camera, view)
    order_lead = orders[0][1].cost - best.cost if orders else math.inf
    if orders and not order_is_sure:
        reject_swapped(places, orders[0][0], order_lead, gate)
    _reject_disagreement(best, freedom, gate)
    _reject_offset(residuals, gate)
    _reject_rivals(found, gate)
    registration = Registration(
        method=Method.NEEDLES,
        anchored_to=AnchoredTo.CAMERA,
        anchor_from_vertebra=Rigid(rotation=best.pose.rotation, translation_mm=best.pose.translation_mm),
        covariance=best.equations.pose_covariance(best.covariance),
    )
    return NeedleFit(
        registration=registration,
        residuals=residuals,
        chi2=best.chi2,
        freedom=freedom,
        sureness=sureness_of(best),
        rivals=len(found) - 1,
        order_lead=order_lead,
    )


def _reject_unpaired(places: Sequence[NeedlePlace], seen: Sequence[NeedleSeen]) -> None:
    if len(places) != len(seen):
        raise InvalidInput(
            "NEEDLES_UNPAIRED",
            f"{len(places)} needles are planned and {len(seen)} are marked in the image",
            "Mark each planned needle once.",
        )


def _residuals(best: Solution) -> tuple[NeedleResidual, ...]:
    task, pose = best.equations.task, best.pose
    off = best.equations.needles_px(pose)
    points = pose.move_points(np.stack([one.point_lps_mm for one in task.places]))
    px_per_mm = task.focal_px.mean() / points[:, 2]
    leaning = task.leaning(pose)
    out = []
    for n, place in enumerate(task.places):
        along = off[n, 0] if task.seen[n].entry_is_seen else 0.0
        offset = float(np.hypot(along, off[n, 1]))
        out.append(
            NeedleResidual(
                name=place.name,
                offset_px=offset,
                offset_mm=offset / float(px_per_mm[n]),
                lean_deg=angle_between_deg(place.direction_lps, leaning[n]),
            )
        )
    return tuple(out)


def _freedom(best: Solution) -> int:
    task = best.equations.task
    return 3 * len(task.places) + 4 + 3 * len(task.view.touched) - 6


def _reject_disagreement(best: Solution, freedom: int, gate: NeedleLimits) -> None:
    probability = float(special.chdtrc(freedom, best.chi2))
    if probability >= gate.min_probability_ratio:
        return
    allowed = float(special.chdtri(freedom, gate.min_probability_ratio))
    raise RegistrationError(
        "NEEDLES_DISAGREE",
        f"needles, ruler and touched points disagree: chi squared is {best.chi2:.0f}, allowed {allowed:.0f}; "
        f"worst is {_worst(best)}",
        "Check which needle is which, where each goes into the bone, V, H and azimuth, and what was touched.",
        {"chi2": best.chi2, "allowed_chi2": allowed},
    )


def _worst(best: Solution) -> str:
    """In words, what is farthest off for how sure it is."""
    task, pose = best.equations.task, best.pose
    names = [f"needle '{one.name[:40]}'" for one in task.places]
    names += [f"touched point '{one.name[:40]}'" for one in task.view.touched]
    by_name = dict(zip(names, best.equations.misfits(pose).tolist(), strict=True))
    view = best.equations.ruler_residuals(pose)
    turned = np.degrees(np.linalg.norm(vector_from_rotation(pose.rotation @ task.view.rotation.T)))
    by_name[f"the camera's tilt, by {turned:.0f} deg"] = float(view[:3] @ view[:3])
    away = float(np.linalg.norm(pose.move_points(task.middle_mm))) - task.view.distance_mm
    by_name[f"the camera's distance, by {away:+.0f} mm"] = float(view[3] ** 2)
    return max(by_name, key=lambda name: by_name[name])


def _reject_offset(residuals: Sequence[NeedleResidual], gate: NeedleLimits) -> None:
    worst = max(residuals, key=lambda one: one.offset_mm)
    if worst.offset_mm > gate.max_offset_mm:
        raise RegistrationError(
            "NEEDLE_OFF_ITS_PLACE",
            f"needle '{worst.name[:40]}' is {worst.offset_mm:.1f} mm ({worst.offset_px:.1f} px) off its "
            f"place, allowed {gate.max_offset_mm:g} mm",
            "Check that each needle is on its landmark and marked where it goes into the bone.",
            {"needle": worst.name[:40], "offset_mm": worst.offset_mm, "offset_px": worst.offset_px},
        )


def _reject_rivals(found: Sequence[Solution], gate: NeedleLimits) -> None:
    best = found[0]
    for other in found[1:]:
        lead = other.cost - best.cost
        if lead < gate.min_lead and _is_apart(best, other):
            turned = vector_from_rotation(other.pose.rotation @ best.pose.rotation.T)
            turned_deg = float(np.degrees(np.linalg.norm(turned)))
            raise RegistrationError(
                "NEEDLES_AMBIGUOUS",
                f"two poses, {turned_deg:.0f} deg apart, explain the needles: the second is worse by "
                f"{lead:.1f} in chi squared, needed {gate.min_lead:g}",
                "Touch one of the needles' entries with the tool's tip, or measure the camera's tilt better.",
                {"lead": lead, "turned_deg": turned_deg},
            )


def _is_apart(best: Solution, other: Solution) -> bool:
    """Whether the other pose lies outside of what the best one's covariance holds anyway."""
    middle = best.equations.task.middle_mm
    off: Array = np.concatenate(
        [
            other.pose.move_points(middle) - best.pose.move_points(middle),
            vector_from_rotation(other.pose.rotation @ best.pose.rotation.T),
        ]
    )
    return float(off @ np.linalg.solve(best.covariance, off)) > 6.0
