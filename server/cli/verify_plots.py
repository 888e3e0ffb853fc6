"""Plots of a verification as SVG: cumulative distribution of errors, and observed against stated coverage."""

from collections.abc import Mapping, Sequence
from html import escape

import numpy as np
import scipy

from tracker.geometry import Array
from tracker.verification import Figures, TheatreRows, Variant, name_of
from tracker.verification.figures import MAX_COVERED, MIN_COVERED, QUANTITIES
from tracker.verification.tool_errors import ErrorSample

WIDE, HIGH, LEFT, TOP, GAP, LINE = 260, 190, 46, 40, 40, 15
COLOURS = ("#0072b2", "#e69f00", "#009e73", "#cc79a7", "#d55e00", "#56b4e9", "#000000", "#999933", "#882255")
MIN_ERROR, MAX_ERROR = 0.01, 100.0


def plots_of(theatres: Sequence[TheatreRows], figures: Figures) -> dict[str, str]:
    """Return the plots by name: `errors`, a curve per variant; `coverage`, observed against stated."""
    variants = [one.variant for one in figures.variants if one.quantities]
    tool_errors = {variant: _errors_of(theatres, variant) for variant in variants}
    return {
        "errors": _page(
            "Share of images (y) with at most this error (x)",
            variants,
            [_errors_panel(name, variants, tool_errors) for name in QUANTITIES],
        ),
        "coverage": _page(
            "Observed coverage (y) of the confidence region of this level (x)",
            variants,
            [_coverage_panel(name, variants, tool_errors) for name in QUANTITIES],
        ),
    }


def _errors_of(theatres: Sequence[TheatreRows], variant: Variant) -> Mapping[str, list[ErrorSample]]:
    shown = [
        row.tool_errors
        for theatre in theatres
        for row in theatre.images
        if row.variant == variant and row.counts and row.tool_errors is not None
    ]
    return {name: [getattr(one, name) for one in shown] for name in QUANTITIES}


def _errors_panel(
    name: str, variants: Sequence[Variant], tool_errors: Mapping[Variant, Mapping[str, list[ErrorSample]]]
) -> list[str]:
    span = np.log10(MAX_ERROR / MIN_ERROR)
    lines = _frame(f"{name}, {QUANTITIES[name]}")
    for power in (-2, -1, 0, 1, 2):
        x = WIDE * (power - np.log10(MIN_ERROR)) / span
        lines += _tick_across(x, f"{10.0**power:g}")
    for number, variant in enumerate(variants):
        errors = np.sort([one.error for one in tool_errors[variant][name]])
        if len(errors):
            across = WIDE * np.clip(np.log10(np.maximum(errors, MIN_ERROR) / MIN_ERROR) / span, 0.0, 1.0)
            lines.append(_curve(across, np.arange(1, len(errors) + 1) / len(errors), number))
    return lines


def _coverage_panel(
    name: str, variants: Sequence[Variant], tool_errors: Mapping[Variant, Mapping[str, list[ErrorSample]]]
) -> list[str]:
    lines = _frame(name)
    low, high = HIGH * (1.0 - MAX_COVERED), HIGH * (1.0 - MIN_COVERED)
    x = 0.95 * WIDE
    lines.append(f"<path d='M{x:.1f} {low:.1f}V{high:.1f}' stroke='#2a2' stroke-width='5' opacity='0.5'/>")
    lines.append(f"<path d='M0 {HIGH}L{WIDE} 0' stroke='#999' stroke-dasharray='4 3'/>")
    for share in (0.0, 0.25, 0.5, 0.75, 1.0):
        lines += _tick_across(WIDE * share, f"{share:.0%}")
    for number, variant in enumerate(variants):
        each = tool_errors[variant][name]
        if each:
            # Level of the smallest confidence region that contains the true value.
            minimum = np.sort(scipy.stats.chi2.cdf([one.mahalanobis_squared for one in each], each[0].dof))
            lines.append(_curve(WIDE * minimum, np.arange(1, len(minimum) + 1) / len(minimum), number))
    return lines


def _page(title: str, variants: Sequence[Variant], panels: Sequence[list[str]]) -> str:
    width = LEFT + len(panels) * (WIDE + GAP)
    height = TOP + HIGH + 2 * LINE + LINE * (len(variants) + 1)
    lines = [
        f"<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {width} {height}' "
        "font-family='sans-serif' font-size='11'>",
        f"<rect width='{width}' height='{height}' fill='#fff'/>",
        f"<text x='6' y='15' font-weight='bold'>{escape(title)}</text>",
    ]
    for number, panel in enumerate(panels):
        lines += [f"<g transform='translate({LEFT + number * (WIDE + GAP)} {TOP})'>", *panel, "</g>"]
    for number, variant in enumerate(variants):
        y = TOP + HIGH + 3 * LINE + LINE * number
        lines.append(f"<path d='M{LEFT} {y - 4}h24' stroke='{_colour(number)}' stroke-width='2'/>")
        lines.append(f"<text x='{LEFT + 30}' y='{y}'>{escape(name_of(variant))}</text>")
    return "\n".join([*lines, "</svg>", ""])


def _frame(title: str) -> list[str]:
    lines = [
        f"<text x='0' y='-6' font-weight='bold'>{escape(title)}</text>",
        f"<rect width='{WIDE}' height='{HIGH}' fill='none' stroke='#888'/>",
    ]
    for share in (0.0, 0.25, 0.5, 0.75, 1.0):
        y = HIGH * (1.0 - share)
        lines.append(f"<path d='M0 {y:.1f}h{WIDE}' stroke='#e5e5e5'/>")
        lines.append(f"<text x='-5' y='{y + 4:.1f}' text-anchor='end'>{share:.0%}</text>")
    return lines


def _tick_across(x: float, words: str) -> list[str]:
    return [
        f"<path d='M{x:.1f} 0V{HIGH}' stroke='#e5e5e5'/>",
        f"<text x='{x:.1f}' y='{HIGH + 14}' text-anchor='middle'>{words}</text>",
    ]


def _curve(across_px: Array, shares: Array, number: int) -> str:
    points = " ".join(f"{x:.1f},{HIGH * (1.0 - y):.1f}" for x, y in zip(across_px, shares, strict=True))
    return f"<polyline points='{points}' fill='none' stroke='{_colour(number)}' stroke-width='1.6'/>"


def _colour(number: int) -> str:
    return COLOURS[number % len(COLOURS)]
