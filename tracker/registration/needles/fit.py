"""Registration from three needles in one image, with its uncertainty.

Image, ruler and touched points are combined in one least-squares fit, weighted by their covariances. Three
needles in one image do not determine the depth, which comes from the ruler. Bone often occludes the entries,
so that P3P on the visible ends is biased. A visible end is therefore modelled as an entry with an offset
along the needle (3 mm, sd 4), unless a person marks the entry itself.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from tracker.camera import CameraModel
from tracker.errors import InvalidInput, RegistrationError
from tracker.geometry import Array, Rigid, angle_between_deg, vector_from_rotation
from tracker.registration.needles.limits import NeedleLimits
from tracker.registration.needles.observability import PoseObservability, pose_observability
from tracker.registration.needles.observation import NeedleObservation
from tracker.registration.needles.order_check import other_orders, reject_swapped
from tracker.registration.needles.planned import PlannedNeedle, reject_poor_geometry
from tracker.registration.needles.pose_solver import Solution, solve_poses
from tracker.registration.needles.residuals import NeedleProblem
from tracker.registration.needles.view_prior import ViewPrior
from tracker.registration.record import AnchoredTo, Method, Registration


@dataclass(frozen=True, slots=True, kw_only=True)
class NeedleResidual:
    """Residual of one needle.

    Attributes:
        name: of the needle.
        offset_px: distance of its planned position from its line in the image, or from its entry if visible.
        offset_mm: the same at the needle's distance.
        lean_deg: angle to its planned direction, in the image; not limited.
    """

    name: str
    offset_px: float
    offset_mm: float
    lean_deg: float


@dataclass(frozen=True, slots=True, kw_only=True)
class NeedleFit:
    """An accepted registration by needles.

    Attributes:
        registration: anchored to the camera.
        residuals: of each needle, in the plan's order.
        chi2: sum of squared whitened residuals of needles, ruler and touched points.
        freedom: degrees of freedom.
        observability: standard deviations by direction, and their share from the image.
        alternatives: number of other local minima.
        order_delta_chi2: smallest increase of chi squared in any other order of the needles; if it is small,
            the image does not identify the needles. Infinite for more than four needles.
    """

    registration: Registration
    residuals: tuple[NeedleResidual, ...]
    chi2: float
    freedom: int
    observability: PoseObservability
    alternatives: int
    order_delta_chi2: float


def register_needles(
    places: Sequence[PlannedNeedle],
    seen: Sequence[NeedleObservation],
    camera: CameraModel,
    view: ViewPrior,
    *,
    limits: NeedleLimits | None = None,
    order_is_sure: bool = False,
) -> NeedleFit:
    """Fit the pose of the vertebra in the camera to needles, view prior and touched points.

    One image of three needles determines the position across the view and the rotation in the image well, but
    depth and tilt hardly; these require the ruler or touched points. The covariance includes the errors of
    the view prior.

    Args:
        places: three or more planned needles.
        seen: the same needles in the image, in the same order.
        camera: calibrated.
        view: tilt and distance of the camera, measured, and touched points.
        limits: of an accepted fit.
        order_is_sure: whether the needles cannot be swapped, as under an overlay.

    Raises:
        InvalidInput: NEEDLES_UNPAIRED.
        RegistrationError: NEEDLES_TOO_FEW, NEEDLES_TOO_CLOSE, NEEDLES_COLLINEAR, NEEDLES_SWAPPED,
            NEEDLES_DISAGREE, NEEDLE_OFF_ITS_PLACE, NEEDLES_AMBIGUOUS.
    """
    gate = limits or NeedleLimits()
    _reject_unpaired(places, seen)
    reject_poor_geometry(places)
    found = solve_poses(NeedleProblem.of(places, seen, camera, view))
    best = found[0]
    residuals = _residuals(best)
    freedom = _freedom(best)
    orders = other_orders(places, seen, camera, view)
    order_delta_chi2 = orders[0][1].cost - best.cost if orders else math.inf
    if orders and not order_is_sure:
        reject_swapped(places, orders[0][0], order_delta_chi2, gate)
    _reject_disagreement(best, freedom, gate)
    _reject_offset(residuals, gate)
    _reject_ambiguous_pose(found, gate)
    registration = Registration(
        method=Method.NEEDLES,
        anchored_to=AnchoredTo.CAMERA,
        anchor_from_vertebra=Rigid(rotation=best.pose.rotation, translation_mm=best.pose.translation_mm),
        covariance=best.residual_model.pose_covariance(best.covariance),
    )
    return NeedleFit(
        registration=registration,
        residuals=residuals,
        chi2=best.chi2,
        freedom=freedom,
        observability=pose_observability(best),
        alternatives=len(found) - 1,
        order_delta_chi2=order_delta_chi2,
    )


def _reject_unpaired(places: Sequence[PlannedNeedle], seen: Sequence[NeedleObservation]) -> None:
    if len(places) != len(seen):
        raise InvalidInput(
            "NEEDLES_UNPAIRED",
            f"{len(places)} needles are planned and {len(seen)} are marked in the image",
            "Mark each planned needle once.",
            {"planned": len(places), "marked": len(seen)},
        )


def _residuals(best: Solution) -> tuple[NeedleResidual, ...]:
    task, pose = best.residual_model.task, best.pose
    off = best.residual_model.needles_px(pose)
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
    task = best.residual_model.task
    return 3 * len(task.places) + 4 + 3 * len(task.view.touched) - 6


def _reject_disagreement(best: Solution, freedom: int, gate: NeedleLimits) -> None:
    probability = float(scipy.special.chdtrc(freedom, best.chi2))
    if probability >= gate.min_probability_ratio:
        return
    allowed = float(scipy.special.chdtri(freedom, gate.min_probability_ratio))
    worst = _worst(best)
    raise RegistrationError(
        "NEEDLES_DISAGREE",
        f"needles, ruler and touched points disagree: chi squared is {best.chi2:.0f}, allowed {allowed:.0f}; "
        f"worst is {worst}",
        "Check the names and entries of the needles, V, H and azimuth, and the touched points.",
        {"chi2": best.chi2, "allowed_chi2": allowed, "worst_observation": worst},
    )


def _worst(best: Solution) -> str:
    """Describe the observation with the largest Mahalanobis distance."""
    task, pose = best.residual_model.task, best.pose
    names = [f"needle '{one.name[:40]}'" for one in task.places]
    names += [f"touched point '{one.name[:40]}'" for one in task.view.touched]
    by_name = dict(zip(names, best.residual_model.misfits(pose).tolist(), strict=True))
    view = best.residual_model.ruler_residuals(pose)
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
            "Check that each needle is on its landmark and marked at its entry into the bone.",
            {
                "needle": worst.name[:40],
                "offset_mm": worst.offset_mm,
                "offset_px": worst.offset_px,
                "allowed_mm": gate.max_offset_mm,
            },
        )


def _reject_ambiguous_pose(found: Sequence[Solution], gate: NeedleLimits) -> None:
    best = found[0]
    for other in found[1:]:
        delta_chi2 = other.cost - best.cost
        if delta_chi2 < gate.min_delta_chi2 and _is_apart(best, other):
            turned = vector_from_rotation(other.pose.rotation @ best.pose.rotation.T)
            turned_deg = float(np.degrees(np.linalg.norm(turned)))
            raise RegistrationError(
                "NEEDLES_AMBIGUOUS",
                f"two poses, {turned_deg:.0f} deg apart, fit the needles: the second is worse by "
                f"{delta_chi2:.1f} in chi squared, needed {gate.min_delta_chi2:g}",
                "Touch a needle's entry with the tool's tip, or measure the camera's tilt more accurately.",
                {
                    "delta_chi2": delta_chi2,
                    "turned_deg": turned_deg,
                    "needed_delta_chi2": gate.min_delta_chi2,
                },
            )


def _is_apart(best: Solution, other: Solution) -> bool:
    """Return whether the other pose lies outside the confidence region of the best one."""
    middle = best.residual_model.task.middle_mm
    off: Array = np.concatenate(
        [
            other.pose.move_points(middle) - best.pose.move_points(middle),
            vector_from_rotation(other.pose.rotation @ best.pose.rotation.T),
        ]
    )
    return float(off @ np.linalg.solve(best.covariance, off)) > 6.0
