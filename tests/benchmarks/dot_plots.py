"""Dot plots as SVG: rows of named dots on a common axis, in adjacent panels."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path

FOLDER = Path(__file__).with_name("plots")
ROW, LABEL, PANEL, TOP, BOTTOM, GAP = 15, 74, 290, 46, 30, 18
DOT = 3.6
FONT = "font-family='sans-serif' font-size='10'"


@dataclass(frozen=True, slots=True, kw_only=True)
class Series:
    """One kind of dot.

    Attributes:
        name: in the legend.
        colour: as SVG writes it.
        values: one for each row; not a number where there is none.
        ranges: low and high of each row, drawn as a thin line; empty for none.
        is_hollow: whether it is a ring, so that a dot under it can be seen.
    """

    name: str
    colour: str
    values: Sequence[float]
    ranges: Sequence[tuple[float, float]] = ()
    is_hollow: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class Panel:
    """Rows of dots on one axis.

    Attributes:
        title: over it.
        rows: their names, top down.
        series: drawn in this order.
        limits: of the axis.
        is_log: whether the axis is logarithmic.
        band: a part of the axis that is shaded, as a goal.
    """

    title: str
    rows: Sequence[str]
    series: Sequence[Series]
    limits: tuple[float, float]
    is_log: bool = False
    band: tuple[float, float] | None = None

    def x(self, value: float) -> float:
        """Return the x position of a value, clipped to the axis."""
        low, high = (math.log10(limit) if self.is_log else limit for limit in self.limits)
        at = math.log10(max(value, 1e-12)) if self.is_log else value
        return LABEL + PANEL * min(max((at - low) / (high - low), 0.0), 1.0)

    @property
    def ticks(self) -> list[float]:
        """Return powers of ten, or fifths of the axis."""
        low, high = self.limits
        if self.is_log:
            powers = range(math.ceil(math.log10(low)), math.floor(math.log10(high)) + 1)
            return [10.0**power for power in powers]
        return [low + (high - low) * part / 5.0 for part in range(6)]


def svg(title: str, panels: Sequence[Panel]) -> str:
    """Return the picture: title, legend of the first panel, and all panels."""
    width = len(panels) * (LABEL + PANEL + GAP)
    height = TOP + ROW * max((len(panel.rows) for panel in panels), default=0) + BOTTOM
    lines = [
        f"<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {width} {height}' {FONT}>",
        f"<rect width='{width}' height='{height}' fill='#fff'/>",
        f"<text x='4' y='13' font-weight='bold'>{escape(title)}</text>",
        *_legend(panels),
    ]
    for number, panel in enumerate(panels):
        lines.append(f"<g transform='translate({number * (LABEL + PANEL + GAP)} {TOP})'>")
        lines += _panel(panel)
        lines.append("</g>")
    return "\n".join([*lines, "</svg>", ""])


def _legend(panels: Sequence[Panel]) -> list[str]:
    lines, x = [], 8.0
    for series in panels[0].series if panels else ():
        lines.append(_dot(x, 25.0, series))
        lines.append(f"<text x='{x + 7:.0f}' y='28'>{escape(series.name)}</text>")
        x += 26.0 + 5.6 * len(series.name)
    return lines


def _panel(panel: Panel) -> list[str]:
    bottom = ROW * len(panel.rows)
    lines = [f"<text x='{LABEL}' y='-4' font-weight='bold'>{escape(panel.title)}</text>"]
    if panel.band is not None:
        left, right = map(panel.x, panel.band)
        lines.append(
            f"<rect x='{left:.1f}' y='0' width='{right - left:.1f}' height='{bottom}' fill='#d8efd8'/>"
        )
    for tick in panel.ticks:
        x = panel.x(tick)
        lines.append(f"<path d='M{x:.1f} 0V{bottom}' stroke='#ddd'/>")
        lines.append(f"<text x='{x:.1f}' y='{bottom + 13}' text-anchor='middle'>{tick:g}</text>")
    for number, name in enumerate(panel.rows):
        y = ROW * (number + 0.5)
        lines.append(f"<text x='{LABEL - 6}' y='{y + 3.5:.1f}' text-anchor='end'>{escape(name)}</text>")
        for series in panel.series:
            if number < len(series.ranges) and math.isfinite(series.values[number]):
                low, high = map(panel.x, series.ranges[number])
                lines.append(f"<path d='M{low:.1f} {y:.1f}H{high:.1f}' stroke='{series.colour}'/>")
            if math.isfinite(series.values[number]):
                lines.append(_dot(panel.x(series.values[number]), y, series))
    return lines


def _dot(x: float, y: float, series: Series) -> str:
    paint = f"fill='none' stroke='{series.colour}'" if series.is_hollow else f"fill='{series.colour}'"
    return f"<circle cx='{x:.1f}' cy='{y:.1f}' r='{DOT}' {paint}/>"


def write_plots(plots: Mapping[str, str], folder: Path = FOLDER) -> None:
    """Write each picture as `<name>.svg`."""
    folder.mkdir(exist_ok=True)
    for name, picture in plots.items():
        (folder / f"{name}.svg").write_text(picture, encoding="utf-8")
