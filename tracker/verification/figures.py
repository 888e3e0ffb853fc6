"""From rows to figures: how large the errors are, and how often what is stated covers them."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy import special

from tracker.geometry import Array
from tracker.registration import AnchoredTo
from tracker.verification.held import Held
from tracker.verification.rows import ImageRow, RegistrationRow, TheatreRows, Variant, Way

# What is stated as 95 % should hold the truth in so many cases.
MIN_COVERED, MAX_COVERED = 0.92, 0.98
QUANTITIES = {"entry": "mm", "angle": "deg", "depth": "mm", "tip": "mm"}


@dataclass(frozen=True, slots=True, kw_only=True)
class Share:
    """How many of how many, with the 95 % interval of the ratio.

    Images of one theatre share its registration: in the interval all of them count as one at most.
    """

    count: int
    of: int
    ratio: float
    low: float
    high: float

    @property
    def is_outside(self) -> bool:
        """Whether it surely lies outside of what is allowed to a stated 95 %."""
        return self.of > 0 and (self.high < MIN_COVERED or self.low > MAX_COVERED)


@dataclass(frozen=True, slots=True, kw_only=True)
class QuantityFigures:
    """One shown quantity.

    Attributes:
        unit: mm or deg.
        median, p95, most: of its error.
        stated: median of what is stated, as the root of the covariance's trace.
        covered: how often the truth is within the stated 95 %.
    """

    unit: str
    median: float
    p95: float
    most: float
    stated: float
    covered: Share


@dataclass(frozen=True, slots=True, kw_only=True)
class VariantFigures:
    """One variant over all theatres.

    Attributes:
        variant: what was verified.
        theatres: in which it was registered.
        looks: images that count.
        shown: of these, those with numbers.
        absent: why the others have none.
        quantities: by name.
        noticed_s: of each theatre whose camera was moved, how long after that numbers were shown that hold
            for where it stood before; empty with a reference.
        wrong_before: images until then that were off by more than their stated 95 %.
        shown_wrong: the same later than a move must be noticed: must be 0.
        through: how many of the true drills were through the wall.
        through_expected: how many were to be expected from what was said.
    """

    variant: Variant
    theatres: int
    looks: int
    shown: int
    absent: Mapping[str, int]
    quantities: Mapping[str, QuantityFigures]
    noticed_s: tuple[float, ...]
    wrong_before: int
    shown_wrong: int
    through: int
    through_expected: float


@dataclass(frozen=True, slots=True, kw_only=True)
class RegistrationFigures:
    """One way to register over all theatres.

    Attributes:
        way, anchored_to: what was made.
        theatres: how many.
        refused: by the code of what refused it.
        check_passed: of those that were registered, how many the check on anatomy lets on.
        check_median_mm: what it measured.
    """

    way: Way
    anchored_to: AnchoredTo
    theatres: int
    rejected: Mapping[str, int]
    check_passed: int
    check_median_mm: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Figures:
    """All of a verification."""

    theatres: int
    registrations: tuple[RegistrationFigures, ...]
    variants: tuple[VariantFigures, ...]

    @property
    def failures(self) -> tuple[str, ...]:
        """What does not hold, in words; nothing where all does."""
        found = []
        for one in self.variants:
            name = name_of(one.variant)
            found += [
                f"{name}: the stated 95 % of the {quantity} hold the truth in {figures.covered.ratio:.1%} "
                f"({figures.covered.low:.1%} to {figures.covered.high:.1%}), allowed "
                f"{MIN_COVERED:.0%} to {MAX_COVERED:.0%}"
                for quantity, figures in one.quantities.items()
                if figures.covered.is_outside
            ]
            if one.shown_wrong:
                found.append(f"{name}: {one.shown_wrong} images showed wrong numbers after the camera moved")
        return tuple(found)


def name_of(variant: Variant) -> str:
    """In words."""
    anchor = "reference" if variant.anchored_to is AnchoredTo.REFERENCE else "no reference"
    return f"{variant.way.value}, {anchor}" + (", camera moved" if variant.camera_moves else "")


def figures_of(theatres: Sequence[TheatreRows], *, noticed_within_s: float) -> Figures:
    """The figures of all theatres together."""
    images: dict[Variant, list[ImageRow]] = {}
    registrations: dict[tuple[Way, AnchoredTo], list[RegistrationRow]] = {}
    for theatre in theatres:
        for image in theatre.images:
            images.setdefault(image.variant, []).append(image)
        for row in theatre.registrations:
            registrations.setdefault((row.way, row.anchored_to), []).append(row)
    order = {way: number for number, way in enumerate(Way)}
    variants = sorted(images, key=lambda one: (order[one.way], one.anchored_to.value, one.camera_moves))
    return Figures(
        theatres=len(theatres),
        registrations=tuple(_registration(key, rows) for key, rows in registrations.items()),
        variants=tuple(_variant(one, images[one], noticed_within_s) for one in variants),
    )


def share_of(covered: Sequence[bool], seeds: Sequence[int]) -> Share:
    """How often something is true, with its interval (Wilson's, of as many as stand alone)."""
    true, of = np.asarray(covered, dtype=np.float64), len(covered)
    if not of:
        return Share(count=0, of=0, ratio=np.nan, low=0.0, high=1.0)
    ratio = float(true.mean())
    _, theatre = np.unique(np.asarray(seeds), return_inverse=True)
    count = int(theatre.max()) + 1
    off = np.bincount(theatre, weights=true - ratio)
    spread = float((off**2).sum()) / of**2 * count / max(count - 1, 1)
    # One registration stands behind all images of a theatre: they never count for more than it does.
    alone = float(np.clip(ratio * (1.0 - ratio) / spread, 1.0, count)) if spread > 0.0 else float(count)
    z = float(special.ndtri(0.975))
    middle = (ratio + z**2 / (2.0 * alone)) / (1.0 + z**2 / alone)
    half = z / (1.0 + z**2 / alone) * np.sqrt(ratio * (1.0 - ratio) / alone + (z / (2.0 * alone)) ** 2)
    return Share(
        count=int(true.sum()), of=of, ratio=ratio, low=float(middle - half), high=float(middle + half)
    )


def _registration(key: tuple[Way, AnchoredTo], rows: Sequence[RegistrationRow]) -> RegistrationFigures:
    distances = [row.check_mm for row in rows if np.isfinite(row.check_mm)]
    return RegistrationFigures(
        way=key[0],
        anchored_to=key[1],
        theatres=len(rows),
        rejected=Counter(row.rejected for row in rows if row.rejected),
        check_passed=sum(row.check_passed for row in rows),
        check_median_mm=float(np.median(distances)) if distances else np.nan,
    )


def _variant(variant: Variant, rows: Sequence[ImageRow], noticed_within_s: float) -> VariantFigures:
    looks = [row for row in rows if row.counts]
    shown = [row for row in looks if row.held is not None]
    stops = variant.camera_moves and variant.anchored_to is AnchoredTo.CAMERA
    after = [row for row in rows if stops and row.since_move_s >= 0.0]
    wrong = [row.since_move_s for row in after if row.held is not None and not row.held.tip.is_covered]
    said = [row for row in shown if np.isfinite(row.through_ratio)]
    return VariantFigures(
        variant=variant,
        theatres=len({row.seed for row in rows}),
        looks=len(looks),
        shown=len(shown),
        absent=Counter(row.absent for row in looks if row.absent),
        quantities={} if stops else {name: _quantity(name, shown) for name in QUANTITIES if shown},
        noticed_s=_noticed_s(after),
        wrong_before=sum(since_s <= noticed_within_s for since_s in wrong),
        shown_wrong=sum(since_s > noticed_within_s for since_s in wrong),
        through=sum(row.is_through for row in said),
        through_expected=float(sum(row.through_ratio for row in said)),
    )


def _noticed_s(after: Sequence[ImageRow]) -> tuple[float, ...]:
    last: dict[int, float] = {}
    for row in after:
        last.setdefault(row.seed, 0.0)
        if row.held is not None:
            last[row.seed] = max(last[row.seed], row.since_move_s)
    return tuple(last.values())


def _quantity(name: str, shown: Sequence[ImageRow]) -> QuantityFigures:
    held: list[Held] = [getattr(row.held, name) for row in shown]
    errors: Array = np.array([one.error for one in held])
    return QuantityFigures(
        unit=QUANTITIES[name],
        median=float(np.median(errors)),
        p95=float(np.percentile(errors, 95)),
        most=float(errors.max()),
        stated=float(np.median([one.stated for one in held])),
        covered=share_of([one.is_covered for one in held], [row.seed for row in shown]),
    )
