"""Report of a verification as tables and JSON."""

from collections.abc import Iterator, Mapping

import numpy as np
from rich.table import Table

from server.number_format import finite
from tracker.registration import AnchoredTo
from tracker.verification import Figures, TheatreRows, Variant, VariantFigures, VerificationSettings, name_of
from tracker.verification.figures import QUANTITIES, QuantityFigures, RegistrationFigures, Share
from tracker.verification.tool_errors import ErrorSample


def tables_of(figures: Figures, settings: VerificationSettings) -> Iterator[Table]:
    """Yield the tables of errors and coverage, registrations, and camera moves."""
    yield _errors(figures)
    yield _registrations(figures)
    yield _moves(figures, settings)


def _errors(figures: Figures) -> Table:
    table = Table(
        title=f"Errors in {figures.theatres} theatres: median / p95 / max; coverage of the 95 % bounds"
    )
    table.add_column("variant")
    table.add_column("shown", justify="right")
    for name, unit in QUANTITIES.items():
        table.add_column(f"{name} {unit}", justify="right")
        table.add_column("coverage %", justify="right")
    for one in figures.variants:
        if not one.quantities:
            continue
        cells = []
        for quantity in one.quantities.values():
            cells += [
                f"{quantity.median:.2f} / {quantity.p95:.2f} / {quantity.max_error:.2f}",
                _covered(quantity.covered),
            ]
        table.add_row(name_of(one.variant), f"{one.shown}/{one.observations}", *cells)
    return table


def _covered(share: Share) -> str:
    mark = " !" if share.is_outside else ""
    return f"{100 * share.ratio:.1f} ({100 * share.low:.0f}-{100 * share.high:.0f}){mark}"


def _registrations(figures: Figures) -> Table:
    table = Table(title="Registrations")
    for heading in ("method", "anchored to", "rejected", "check passed", "check, median mm"):
        table.add_column(heading)
    for one in figures.registrations:
        rejected = ", ".join(f"{count} {code}" for code, count in sorted(one.rejected.items())) or "none"
        table.add_row(
            one.method.value,
            one.anchored_to.value,
            rejected,
            f"{one.check_passed}/{one.theatres - sum(one.rejected.values())}",
            f"{one.check_median_mm:.2f}",
        )
    return table


def _moves(figures: Figures, settings: VerificationSettings) -> Table:
    table = Table(title=f"Camera moved, no reference: detected within {settings.noticed_within_s:g} s?")
    for heading in (
        "method",
        "detected after s, median / max",
        "wrong before",
        "wrong after",
        "reason shown",
    ):
        table.add_column(heading)
    for one in figures.variants:
        if not one.noticed_s:
            continue
        table.add_row(
            one.variant.method.value,
            f"{np.median(one.noticed_s):.2f} / {max(one.noticed_s):.2f}",
            f"{one.wrong_before} images",
            f"{one.shown_wrong} images",
            ", ".join(f"{count} {reason}" for reason, count in sorted(one.absent.items())),
        )
    return table


def figures_value(figures: Figures, settings: VerificationSettings) -> dict[str, object]:
    """Return the figures as a JSON object; NaN becomes null."""
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
        "method": one.method.value,
        "anchored_to": one.anchored_to.value,
        "theatres": one.theatres,
        "rejected": dict(sorted(one.rejected.items())),
        "check_passed": one.check_passed,
        "check_median_mm": finite(one.check_median_mm),
    }


def _variant_value(one: VariantFigures) -> dict[str, object]:
    return {
        **_variant_names(one.variant),
        "theatres": one.theatres,
        "observations": one.observations,
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
        "method": variant.method.value,
        "reference": variant.anchored_to is AnchoredTo.REFERENCE,
        "camera_moves": variant.camera_moves,
    }


def _quantity_value(one: QuantityFigures) -> dict[str, object]:
    return {
        "unit": one.unit,
        "median": one.median,
        "p95": one.p95,
        "max_error": one.max_error,
        "stated_sd": one.stated_sd,
        "covered": one.covered.count,
        "of": one.covered.of,
        "covered_ratio": one.covered.ratio,
        "covered_95_ratio": [one.covered.low, one.covered.high],
    }


def row_values(theatre: TheatreRows) -> Iterator[dict[str, object]]:
    """Yield one row per image of a theatre."""
    for one in theatre.images:
        tool_errors: Mapping[str, ErrorSample] = (
            {} if one.tool_errors is None else {name: getattr(one.tool_errors, name) for name in QUANTITIES}
        )
        yield {
            "seed": one.seed,
            **_variant_names(one.variant),
            "at_s": one.at_s,
            "phase": one.phase.value,
            "counts": one.counts,
            "since_move_s": finite(one.since_move_s),
            "absent": one.absent or None,
            **{
                f"{name}_{key}": value
                for name, each in tool_errors.items()
                for key, value in (
                    (f"error_{QUANTITIES[name]}", each.error),
                    (f"stated_{QUANTITIES[name]}", each.stated_sd),
                    ("mahalanobis_squared", each.mahalanobis_squared),
                    ("is_within_95", each.is_within_95),
                )
            },
            "is_through": one.is_through,
            "through_ratio": finite(one.through_ratio),
        }
