"""Statistics of a verification: error percentiles and coverage of the stated 95 % regions."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from tracker.geometry import Array
from tracker.registration import AnchoredTo
from tracker.verification.rows import ImageRow, RegistrationMethod, RegistrationRow, TheatreRows, Variant
from tracker.verification.tool_errors import ErrorSample

# Allowed coverage of the stated 95 % regions.
MIN_COVERED, MAX_COVERED = 0.92, 0.98
QUANTITIES = {"entry": "mm", "angle": "deg", "depth": "mm", "tip": "mm"}


@dataclass(frozen=True, slots=True, kw_only=True)
class Share:
    """A proportion with its 95 % confidence interval.

    Images of one theatre share its registration, so the effective sample size is at most the number of
    theatres.
    """

    count: int
    of: int
    ratio: float
    low: float
    high: float

    @property
    def is_outside(self) -> bool:
        """Return whether the interval lies entirely outside the allowed coverage."""
        return self.of > 0 and (self.high < MIN_COVERED or self.low > MAX_COVERED)


@dataclass(frozen=True, slots=True, kw_only=True)
class QuantityFigures:
    """Error and coverage of one displayed quantity.

    Attributes:
        unit: mm or deg.
        median, p95, max_error: of its error.
        stated_sd: median of the stated sd, the root of the covariance's trace.
        covered: share of images in which the stated 95 % region contains the true value.
    """

    unit: str
    median: float
    p95: float
    max_error: float
    stated_sd: float
    covered: Share


@dataclass(frozen=True, slots=True, kw_only=True)
class VariantFigures:
    """Statistics of one variant over all theatres.

    Attributes:
        variant: the verified configuration.
        theatres: number of theatres with a registration.
        observations: number of counting images.
        shown: number of these with displayed values.
        absent: number of the others by reason.
        quantities: statistics by name.
        noticed_s: for each theatre whose camera was moved, time after the move during which values for the
            old camera pose were displayed; empty with a reference.
        wrong_before: number of images in that time with an error outside the stated 95 % region.
        shown_wrong: the same after the detection limit; must be 0.
        through: number of images in which the true drill perforates the wall.
        through_expected: expected number from the stated probabilities.
    """

    variant: Variant
    theatres: int
    observations: int
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
    """Statistics of one registration method over all theatres.

    Attributes:
        method, anchored_to: the registration method, and camera or reference.
        theatres: number of theatres.
        rejected: number of rejections by error code.
        check_passed: number of registrations that passed the anatomical check.
        check_median_mm: median distance of that check.
    """

    method: RegistrationMethod
    anchored_to: AnchoredTo
    theatres: int
    rejected: Mapping[str, int]
    check_passed: int
    check_median_mm: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Figures:
    """Statistics of a whole verification."""

    theatres: int
    registrations: tuple[RegistrationFigures, ...]
    variants: tuple[VariantFigures, ...]

    @property
    def failures(self) -> tuple[str, ...]:
        """Return a message for each criterion that is not met."""
        found = []
        for one in self.variants:
            name = name_of(one.variant)
            found += [
                f"{name}: the stated 95 % regions of the {quantity} contain the truth in "
                f"{figures.covered.ratio:.1%} ({figures.covered.low:.1%} to {figures.covered.high:.1%}), "
                f"allowed {MIN_COVERED:.0%} to {MAX_COVERED:.0%}"
                for quantity, figures in one.quantities.items()
                if figures.covered.is_outside
            ]
            if one.shown_wrong:
                found.append(f"{name}: {one.shown_wrong} images showed wrong numbers after the camera moved")
        return tuple(found)


def name_of(variant: Variant) -> str:
    """Return the display name of a variant."""
    anchor = "reference" if variant.anchored_to is AnchoredTo.REFERENCE else "no reference"
    return f"{variant.method.value}, {anchor}" + (", camera moved" if variant.camera_moves else "")


def drill_figures(theatres: Sequence[TheatreRows], *, noticed_within_s: float) -> Figures:
    """Return the statistics over all theatres."""
    images: dict[Variant, list[ImageRow]] = {}
    registrations: dict[tuple[RegistrationMethod, AnchoredTo], list[RegistrationRow]] = {}
    for theatre in theatres:
        for image in theatre.images:
            images.setdefault(image.variant, []).append(image)
        for row in theatre.registrations:
            registrations.setdefault((row.method, row.anchored_to), []).append(row)
    order = {method: number for number, method in enumerate(RegistrationMethod)}
    variants = sorted(images, key=lambda one: (order[one.method], one.anchored_to.value, one.camera_moves))
    return Figures(
        theatres=len(theatres),
        registrations=tuple(_registration(key, rows) for key, rows in registrations.items()),
        variants=tuple(_variant(one, images[one], noticed_within_s) for one in variants),
    )


def share_of(covered: Sequence[bool], seeds: Sequence[int]) -> Share:
    """Return a proportion with its Wilson interval; the sample size accounts for clusters (theatres)."""
    true, of = np.asarray(covered, dtype=np.float64), len(covered)
    if not of:
        return Share(count=0, of=0, ratio=np.nan, low=0.0, high=1.0)
    ratio = float(true.mean())
    _, theatre = np.unique(np.asarray(seeds), return_inverse=True)
    count = int(theatre.max()) + 1
    off = np.bincount(theatre, weights=true - ratio)
    spread = float((off**2).sum()) / of**2 * count / max(count - 1, 1)
    # All images of a theatre share one registration: the effective sample size is at most the theatres.
    alone = float(np.clip(ratio * (1.0 - ratio) / spread, 1.0, count)) if spread > 0.0 else float(count)
    z = float(scipy.special.ndtri(0.975))
    middle = (ratio + z**2 / (2.0 * alone)) / (1.0 + z**2 / alone)
    half = z / (1.0 + z**2 / alone) * np.sqrt(ratio * (1.0 - ratio) / alone + (z / (2.0 * alone)) ** 2)
    return Share(
        count=int(true.sum()), of=of, ratio=ratio, low=float(middle - half), high=float(middle + half)
    )


def _registration(
    key: tuple[RegistrationMethod, AnchoredTo], rows: Sequence[RegistrationRow]
) -> RegistrationFigures:
    distances = [row.check_mm for row in rows if np.isfinite(row.check_mm)]
    return RegistrationFigures(
        method=key[0],
        anchored_to=key[1],
        theatres=len(rows),
        rejected=Counter(row.rejected for row in rows if row.rejected),
        check_passed=sum(row.check_passed for row in rows),
        check_median_mm=float(np.median(distances)) if distances else np.nan,
    )


def _variant(variant: Variant, rows: Sequence[ImageRow], noticed_within_s: float) -> VariantFigures:
    observations = [row for row in rows if row.counts]
    shown = [row for row in observations if row.tool_errors is not None]
    stops = variant.camera_moves and variant.anchored_to is AnchoredTo.CAMERA
    after = [row for row in rows if stops and row.since_move_s >= 0.0]
    wrong = [
        row.since_move_s
        for row in after
        if row.tool_errors is not None and not row.tool_errors.tip.is_within_95
    ]
    with_probability = [row for row in shown if np.isfinite(row.through_ratio)]
    return VariantFigures(
        variant=variant,
        theatres=len({row.seed for row in rows}),
        observations=len(observations),
        shown=len(shown),
        absent=Counter(row.absent for row in observations if row.absent),
        quantities={} if stops else {name: _quantity(name, shown) for name in QUANTITIES if shown},
        noticed_s=_noticed_s(after),
        wrong_before=sum(since_s <= noticed_within_s for since_s in wrong),
        shown_wrong=sum(since_s > noticed_within_s for since_s in wrong),
        through=sum(row.is_through for row in with_probability),
        through_expected=float(sum(row.through_ratio for row in with_probability)),
    )


def _noticed_s(after: Sequence[ImageRow]) -> tuple[float, ...]:
    last: dict[int, float] = {}
    for row in after:
        last.setdefault(row.seed, 0.0)
        if row.tool_errors is not None:
            last[row.seed] = max(last[row.seed], row.since_move_s)
    return tuple(last.values())


def _quantity(name: str, shown: Sequence[ImageRow]) -> QuantityFigures:
    tool_errors: list[ErrorSample] = [getattr(row.tool_errors, name) for row in shown]
    errors: Array = np.array([one.error for one in tool_errors])
    return QuantityFigures(
        unit=QUANTITIES[name],
        median=float(np.median(errors)),
        p95=float(np.percentile(errors, 95)),
        max_error=float(errors.max()),
        stated_sd=float(np.median([one.stated_sd for one in tool_errors])),
        covered=share_of([one.is_within_95 for one in tool_errors], [row.seed for row in shown]),
    )
