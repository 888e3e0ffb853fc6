"""Markdown tables, and the two figures that stand in them: median and a high percentile."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

NOTHING = "–"


@dataclass(frozen=True, slots=True, kw_only=True)
class Table:
    """A heading, a table under it, and what must be said about it."""

    title: str
    columns: Sequence[str]
    rows: Sequence[Sequence[str]]
    note: str = ""

    @property
    def markdown(self) -> str:
        """The table as Markdown, its first column to the left and all others to the right."""
        lines = [f"**{self.title}**", ""] if self.title else []
        lines.append("| " + " | ".join(self.columns) + " |")
        lines.append("|" + "|".join(["---", *["---:"] * (len(self.columns) - 1)]) + "|")
        lines += ["| " + " | ".join(row) + " |" for row in self.rows]
        if self.note:
            lines += ["", self.note]
        return "\n".join(lines) + "\n"


def percentile(values: Iterable[float], percent: float) -> float:
    """This percentile of the finite values; not a number when there are none."""
    array = np.fromiter(values, dtype=np.float64)
    array = array[np.isfinite(array)]
    return float(np.percentile(array, percent)) if len(array) else float("nan")


def median(values: Iterable[float]) -> float:
    """The median of the finite values; not a number when there are none."""
    return percentile(values, 50.0)


def number(value: float, digits: int = 2) -> str:
    """A number with so many digits behind the point; a dash where there is none."""
    return f"{value:.{digits}f}" if np.isfinite(value) else NOTHING


def pair(values: Iterable[float], percent: float, digits: int = 2) -> str:
    """Median and this percentile: `0.21 / 0.64`."""
    listed = list(values)
    return (
        f"{number(median(listed), digits)} / {number(percentile(listed, percent), digits)}"
        if listed
        else NOTHING
    )


def share(part: int, whole: int, digits: int = 1) -> str:
    """Part of a whole in per cent; a dash when there is no whole."""
    return f"{100.0 * part / whole:.{digits}f} %" if whole else NOTHING
