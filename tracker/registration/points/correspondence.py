"""Detect swapped or mirrored landmarks: another correspondence fits better than the given one.

Left and right of a vertebra are similar, so most correct landmarks also fit swapped; rejecting those would
reject the common case. The given order is rejected only if another order or the mirror image fits clearly
better; the check on anatomy detects the rest.
"""

from dataclasses import dataclass
from functools import cache
from itertools import combinations, permutations

import numpy as np
import numpy.typing as npt
import scipy

from tracker.errors import RegistrationError, Remark
from tracker.geometry import Array
from tracker.registration.points.pairs import PointPairs
from tracker.registration.points.settings import PointSettings

Orders = npt.NDArray[np.int64]

# Up to this number of points every order is tried (719 others of six); with more points only swapped pairs,
# shifted lists and the order with the best matching distances.
ALL_ORDERS_UP_TO = 6
# With more points, which are not touched by hand, only shifted and reversed lists are tried.
PAIRS_UP_TO = 60


@dataclass(frozen=True, slots=True, kw_only=True)
class AlternativeOrder:
    """Another correspondence of the same points.

    Attributes:
        fre_mm: its fiducial registration error.
        order: for each captured point the index of its marked one.
    """

    fre_mm: float
    order: tuple[int, ...]


def best_alternative_order(fixed_mm: Array, moving_mm: Array) -> AlternativeOrder:
    """Return the best-fitting order of n points (n, 3) other than the given one; n at least 3."""
    orders = _other_orders(fixed_mm, moving_mm)
    fres = _fres_mm(fixed_mm, moving_mm, orders)
    # Among orders that fit equally well, the one with the fewest changes.
    moved = (orders != np.arange(len(fixed_mm))).sum(axis=1)
    equal_fits = np.flatnonzero(fres <= fres.min() * 1.05 + 1e-9)
    best = equal_fits[np.argmin(moved[equal_fits])]
    return AlternativeOrder(fre_mm=float(fres[best]), order=tuple(int(one) for one in orders[best]))


def mirrored_fre_mm(fixed_mm: Array, moving_mm: Array) -> float:
    """Return the FRE of the mirrored captured points; equals that of the points if they are coplanar."""
    given = np.arange(len(fixed_mm))[None]
    return float(_fres_mm(fixed_mm, moving_mm, given, mirrored=True)[0])


def reject_swapped_or_mirrored(
    pairs: PointPairs, fre_mm: float, settings: PointSettings
) -> tuple[Remark, ...]:
    """Reject a wrong correspondence; return remarks on an ambiguous one.

    Points that would also fit in another order (as left and right of a vertebra) are accepted if the given
    order fits; a remark then states that a swap would not be detected.

    Raises:
        RegistrationError: POINTS_SWAPPED or POINTS_MIRRORED, another correspondence fits clearly better;
            POINTS_AMBIGUOUS, the given order fits badly and another one better, but not well either.
    """
    alternative = best_alternative_order(pairs.fixed_mm, pairs.moving_mm)
    mirrored = mirrored_fre_mm(pairs.fixed_mm, pairs.moving_mm)
    fits = fre_mm <= settings.max_accepted_fre_mm
    numbers = {"fre_mm": fre_mm, "other_order_fre_mm": alternative.fre_mm, "mirrored_fre_mm": mirrored}
    swapped = _swap_text(alternative.order, pairs.labels)
    order = {
        "order": [pairs.labels[one] for one in alternative.order],
        "exchanged": [pairs.labels[n] for n, one in enumerate(alternative.order) if n != one],
        "exchanged_points": swapped,
    }
    if (
        not fits
        and settings.min_improvement_ratio * alternative.fre_mm < fre_mm
        and alternative.fre_mm <= 1.5 * mirrored
    ):
        raise RegistrationError(
            "POINTS_SWAPPED",
            f"{swapped} seem to be swapped: as given the points fit to {fre_mm:.2f} mm RMS, "
            f"swapped to {alternative.fre_mm:.2f} mm",
            "Touch these landmarks again, each when its name is shown, or put the rows in order.",
            {**numbers, **order},
        )
    if not fits and settings.min_improvement_ratio * mirrored < fre_mm:
        raise RegistrationError(
            "POINTS_MIRRORED",
            f"the points are mirrored: as given they fit to {fre_mm:.2f} mm RMS, "
            f"their mirror image to {mirrored:.2f} mm",
            "Check that left and right landmarks are not exchanged, and that no axis has the wrong sign "
            "(LPS and RAS differ in two signs, not in one).",
            numbers,
        )
    if not fits and alternative.fre_mm < fre_mm:
        raise RegistrationError(
            "POINTS_AMBIGUOUS",
            f"the points fit to {fre_mm:.2f} mm RMS as given, and better ({alternative.fre_mm:.2f} mm) "
            f"with {swapped} swapped, so that their order is ambiguous",
            "Touch the landmarks again, and choose ones whose distances from each other differ.",
            {**numbers, **order},
        )
    if alternative.fre_mm > max(settings.max_accepted_fre_mm, settings.min_improvement_ratio * fre_mm):
        return ()
    return (
        Remark(
            code="POINTS_SWAP_UNDETECTABLE",
            message=f"a swap of {swapped} would not be detected: the points fit to "
            f"{fre_mm:.2f} mm RMS as given and to {alternative.fre_mm:.2f} mm swapped",
            remedy="Check on a landmark that was not used, on one side; or add one that makes the sides "
            "differ.",
            context={**numbers, **order},
        ),
    )


def _fres_mm(fixed_mm: Array, moving_mm: Array, orders: Orders, *, mirrored: bool = False) -> Array:
    """Return the FRE (k,) of the best rigid fit of each of k orders (k, n), from singular values alone."""
    fixed = fixed_mm - fixed_mm.mean(axis=0)
    moving = moving_mm - moving_mm.mean(axis=0)
    products = np.einsum("kni,nj->kij", fixed[orders], moving)
    sizes = np.linalg.svd(products, compute_uv=False)
    sign = np.where(np.linalg.det(products) < 0.0, -1.0, 1.0) * (-1.0 if mirrored else 1.0)
    gained = sizes[:, 0] + sizes[:, 1] + sign * sizes[:, 2]
    squares = (fixed**2).sum() + (moving**2).sum() - 2.0 * gained
    return np.asarray(np.sqrt(np.maximum(squares, 0.0) / len(fixed)))


def _other_orders(fixed_mm: Array, moving_mm: Array) -> Orders:
    count = len(fixed_mm)
    given = tuple(range(count))
    if count <= ALL_ORDERS_UP_TO:
        return _all_other_orders(count)
    orders = {given[1:] + given[:1], given[-1:] + given[:-1], given[::-1]}
    if count > PAIRS_UP_TO:
        return np.array(sorted(orders))
    orders |= {given[by:] + given[:by] for by in range(1, count)}
    for first, second in combinations(given, 2):
        order = list(given)
        order[first], order[second] = second, first
        orders.add(tuple(order))
    orders.add(_order_by_distances(fixed_mm, moving_mm))
    return np.array(sorted(orders - {given}))


@cache
def _all_other_orders(count: int) -> Orders:
    given = tuple(range(count))
    orders = np.array([order for order in permutations(given) if order != given], dtype=np.int64)
    orders.setflags(write=False)
    return orders


def _order_by_distances(fixed_mm: Array, moving_mm: Array) -> tuple[int, ...]:
    """Return the order in which each point's sorted distances to the others agree best."""
    ours = np.sort(np.linalg.norm(moving_mm[:, None] - moving_mm[None], axis=2), axis=1)
    theirs = np.sort(np.linalg.norm(fixed_mm[:, None] - fixed_mm[None], axis=2), axis=1)
    costs = ((ours[:, None] - theirs[None]) ** 2).sum(axis=2)
    return tuple(int(one) for one in scipy.optimize.linear_sum_assignment(costs)[1])


def _swap_text(order: tuple[int, ...], labels: tuple[str, ...]) -> str:
    """Return the swapped points as text."""
    left, rings = set(range(len(order))), []
    while left:
        ring = [min(left)]
        while order[ring[-1]] != ring[0]:
            ring.append(order[ring[-1]])
        left -= set(ring)
        if len(ring) > 1:
            names = [labels[one] for one in ring]
            rings.append(f"{', '.join(names[:-1])} and {names[-1]}")
    return "points " + "; ".join(rings)
