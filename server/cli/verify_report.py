"""What a verification gives, as tables and as JSON."""

import math
from collections.abc import Iterator, Mapping

import numpy as np
from rich.table import Table

from tracker.registration import AnchoredTo
from tracker.verification import Figures, TheatreRows, Variant, VariantFigures, VerificationSettings, name_of
from tracker.verification.figures import QUANTITIES, QuantityFigures, RegistrationFigures, Share
from tracker.verification.held import Held


def tables_of(figures: Figures, settings: VerificationSettings) -> Iterator[Table]:
    """Errors with their coverage, registrations, and what a moved camera does."""
    yield _errors(figures)
    yield _registrations(figures)
    yield _moves(figures, settings)


def _errors(figures: Figures) -> Table:
    table = Table(title=f"Shown against true, {figures.theatres} theatres: median / p95 / worst; covered")
    table.add_column("variant")
    table.add_column("shown", justify="right")
    for name, unit in QUANTITIES.items():
        table.add_column(f"{name} {unit}", justify="right")
        table.add_column("within 95 %", justify="right")
    for one in figures.variants:
        if not one.quantities:
            continue
        cells = []
        for quantity in one.quantities.values():
            cells += [
                f"{quantity.median:.2f} / {quantity.p95:.2f} / {quantity.most:.2f}",
                _covered(quantity.covered),
            ]
        table.add_row(name_of(one.variant), f"{one.shown}/{one.looks}", *cells)
    return table


def _covered(share: Share) -> str:
    mark = " !" if share.is_outside else ""
    return f"{100 * share.ratio:.1f} ({100 * share.low:.0f}-{100 * share.high:.0f}){mark}"


def _registrations(figures: Figures) -> Table:
    table = Table(title="Registrations")
    for heading in ("way", "anchored to", "rejected", "check passed", "check, median mm"):
        table.add_column(heading)
    for one in figures.registrations:
        rejected = ", ".join(f"{count} {code}" for code, count in sorted(one.rejected.items())) or "none"
        table.add_row(
            one.way.value,
            one.anchored_to.value,
            rejected,
            f"{one.check_passed}/{one.theatres - sum(one.rejected.values())}",
            f"{one.check_median_mm:.2f}",
        )
    return table


def _moves(figures: Figures, settings: VerificationSettings) -> Table:
    table = Table(title=f"Camera moved, no reference: noticed within {settings.noticed_within_s:g} s?")
    for heading in ("way", "noticed after s, median / worst", "wrong until then", "wrong after", "absent as"):
        table.add_column(heading)
    for one in figures.variants:
        if not one.noticed_s:
            continue
        table.add_row(
            one.variant.way.value,
            f"{np.median(one.noticed_s):.2f} / {max(one.noticed_s):.2f}",
            f"{one.wrong_before} images",
            f"{one.shown_wrong} images",
            ", ".join(f"{count} {reason}" for reason, count in sorted(one.absent.items())),
        )
    return table


def figures_value(figures: Figures, settings: VerificationSettings) -> dict[str, object]:
    """The same as JSON has it; what is no number is null."""
    return {
        "theatres": figures.theatres,
        "passed": not figures.failures,
        "failures": list(figures.failures),
        "noticed_within_s": settings.noticed_within_s,
        "registrations": [_registration_value(one) for one in figures.registrations],
        "variants": [_variant_value(one) for one in figures.variants],
    }


def _registration_value(one: RegistrationFigures) -> dict[str, object]:
    return {
        "way": one.way.value,
        "anchored_to": one.anchored_to.value,
        "theatres": one.theatres,
        "rejected": dict(sorted(one.rejected.items())),
        "check_passed": one.check_passed,
        "check_median_mm": _finite(one.check_median_mm),
    }


def _variant_value(one: VariantFigures) -> dict[str, object]:
    return {
        **_variant_names(one.variant),
        "theatres": one.theatres,
        "looks": one.looks,
        "shown": one.shown,
        "absent": dict(sorted(one.absent.items())),
        "errors": {name: _quantity_value(quantity) for name, quantity in one.quantities.items()},
        "noticed_s": list(one.noticed_s),
        "wrong_before_noticed": one.wrong_before,
        "shown_wrong": one.shown_wrong,
        "through": one.through,
        "through_expected": one.through_expected,
    }


def _variant_names(variant: Variant) -> dict[str, object]:
    return {
        "way": variant.way.value,
        "reference": variant.anchored_to is AnchoredTo.REFERENCE,
        "camera_moves": variant.camera_moves,
    }


def _quantity_value(one: QuantityFigures) -> dict[str, object]:
    return {
        "unit": one.unit,
        "median": one.median,
        "p95": one.p95,
        "most": one.most,
        "stated": one.stated,
        "covered": one.covered.count,
        "of": one.covered.of,
        "covered_ratio": one.covered.ratio,
        "covered_95_ratio": [one.covered.low, one.covered.high],
    }


def row_values(theatre: TheatreRows) -> Iterator[dict[str, object]]:
    """Every image of a theatre."""
    for one in theatre.images:
        held: Mapping[str, Held] = (
            {} if one.held is None else {name: getattr(one.held, name) for name in QUANTITIES}
        )
        yield {
            "seed": one.seed,
            **_variant_names(one.variant),
            "at_s": one.at_s,
            "phase": one.phase.value,
            "counts": one.counts,
            "since_move_s": _finite(one.since_move_s),
            "absent": one.absent or None,
            **{
                f"{name}_{key}": value
                for name, each in held.items()
                for key, value in (
                    (f"error_{QUANTITIES[name]}", each.error),
                    (f"stated_{QUANTITIES[name]}", each.stated),
                    ("surprise", each.surprise),
                    ("is_covered", each.is_covered),
                )
            },
            "is_through": one.is_through,
            "through_ratio": _finite(one.through_ratio),
        }


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None
