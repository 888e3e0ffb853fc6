"""Check the correspondence of marked and planned needles against the image."""

import itertools
from collections.abc import Sequence

from tracker.camera import CameraModel
from tracker.errors import RegistrationError
from tracker.registration.needles.limits import NeedleLimits
from tracker.registration.needles.observation import NeedleObservation
from tracker.registration.needles.planned import PlannedNeedle
from tracker.registration.needles.pose_solver import Solution, solve_from_view
from tracker.registration.needles.residuals import NeedleProblem
from tracker.registration.needles.view_prior import ViewPrior

# With more needles there are too many orders, and a swapped pair already has large residuals.
MAX_NEEDLES = 4


def other_orders(
    places: Sequence[PlannedNeedle], seen: Sequence[NeedleObservation], camera: CameraModel, view: ViewPrior
) -> list[tuple[tuple[int, ...], Solution]]:
    """Return the most likely pose of every other order of the needles, the most likely order first."""
    if len(places) > MAX_NEEDLES:
        return []
    orders = list(itertools.permutations(range(len(places))))[1:]
    found = []
    for order in orders:
        task = NeedleProblem.of(places, [seen[i] for i in order], camera, view)
        found.append((order, solve_from_view(task)))
    return sorted(found, key=lambda one: one[1].cost)


def reject_swapped(
    places: Sequence[PlannedNeedle], order: Sequence[int], delta_chi2: float, gate: NeedleLimits
) -> None:
    """Reject needles that fit the image clearly better in another order.

    Raises:
        RegistrationError: NEEDLES_SWAPPED.
    """
    if delta_chi2 >= -gate.max_swap_delta_chi2:
        return
    needles = ", ".join(f"'{places[n].name[:40]}'" for n, at in enumerate(order) if n != at)
    raise RegistrationError(
        "NEEDLES_SWAPPED",
        f"needles {needles} seem to be swapped: the other order fits better by "
        f"{-delta_chi2:.1f} in chi squared, allowed {gate.max_swap_delta_chi2:g}",
        "Mark each needle again under its own name, or touch the entry of one with the tool's tip.",
        {
            "needles": needles,
            "delta_chi2": delta_chi2,
            "gain_chi2": -delta_chi2,
            "allowed_chi2": gate.max_swap_delta_chi2,
        },
    )
