"""Which needle is which: whether the image bears out the order in which they were marked."""

import itertools
from collections.abc import Sequence

from tracker.camera import CameraModel
from tracker.errors import RegistrationError
from tracker.registration.needles.equations import Task
from tracker.registration.needles.limits import NeedleLimits
from tracker.registration.needles.places import NeedlePlace
from tracker.registration.needles.seen import NeedleSeen
from tracker.registration.needles.solutions import Solution, nearest_solution
from tracker.registration.needles.view import View

# With more needles there are too many orders, and one swapped pair already disagrees with the rest.
MAX_NEEDLES = 4


def other_orders(
    places: Sequence[NeedlePlace], seen: Sequence[NeedleSeen], camera: CameraModel, view: View
) -> list[tuple[tuple[int, ...], Solution]]:
    """The likeliest pose of every other order of the needles seen, the likeliest order first."""
    if len(places) > MAX_NEEDLES:
        return []
    orders = list(itertools.permutations(range(len(places))))[1:]
    found = []
    for order in orders:
        task = Task.of(places, [seen[i] for i in order], camera, view)
        found.append((order, nearest_solution(task)))
    return sorted(found, key=lambda one: one[1].cost)


def reject_swapped(
    places: Sequence[NeedlePlace], order: Sequence[int], lead: float, gate: NeedleLimits
) -> None:
    """Refuse needles that explain the image clearly better in another order.

    Raises:
        RegistrationError: NEEDLES_SWAPPED.
    """
    if lead >= -gate.max_lead_of_swapped:
        return
    swapped = [f"'{places[n].name[:40]}'" for n, at in enumerate(order) if n != at]
    raise RegistrationError(
        "NEEDLES_SWAPPED",
        f"needles {' and '.join(swapped)} seem to be marked for one another: the other order fits better by "
        f"{-lead:.1f} in chi squared, allowed {gate.max_lead_of_swapped:g}",
        "Mark each needle again under its own name, or touch one where it goes in with the tool's tip.",
        {"lead": lead},
    )
