"""Markdown tables, and formatting of medians and percentiles."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

NOTHING = "–"


@dataclass(frozen=True, slots=True, kw_only=True)
class Table:
    """A table with title and note."""

    title: str
    columns: Sequence[str]
    rows: Sequence[Sequence[str]]
    note: str = ""

    @property
    def markdown(self) -> str:
        """Return the table as Markdown, first column left-aligned, others right-aligned."""
        lines = [f"**{self.title}**", ""] if self.title else []
        lines.append("| " + " | ".join(self.columns) + " |")
        lines.append("|" + "|".join(["---", *["---:"] * (len(self.columns) - 1)]) + "|")
        lines += ["| " + " | ".join(row) + " |" for row in self.rows]
        if self.note:
            lines += ["", self.note]
        return "\n".join(lines) + "\n"


def percentile(values: Iterable[float], percent: float) -> float:
    """Return this percentile of the finite values; NaN without any."""
    array = np.fromiter(values, dtype=np.float64)
    array = array[np.isfinite(array)]
    return float(np.percentile(array, percent)) if len(array) else float("nan")


def median(values: Iterable[float]) -> float:
    """Return the median of the finite values; NaN without any."""
    return percentile(values, 50.0)


def number(value: float, digits: int = 2) -> str:
    """Format a number with this many decimals; a dash for NaN."""
    return f"{value:.{digits}f}" if np.isfinite(value) else NOTHING


def pair(values: Iterable[float], percent: float, digits: int = 2) -> str:
    """Format median and percentile: `0.21 / 0.64`."""
    listed = list(values)
    return (
        f"{number(median(listed), digits)} / {number(percentile(listed, percent), digits)}"
        if listed
        else NOTHING
    )


def share(part: int, whole: int, digits: int = 1) -> str:
    """Format a share in per cent; a dash if the whole is 0."""
    return f"{100.0 * part / whole:.{digits}f} %" if whole else NOTHING
