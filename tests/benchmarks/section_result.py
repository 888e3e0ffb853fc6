"""Result of a section of the benchmark."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from tests.benchmarks.figures import Figure
from tests.benchmarks.tables import Table


@dataclass(frozen=True, slots=True, kw_only=True)
class SectionResult:
    """Tables for the README, figures for the next run, plots.

    Attributes:
        tables: in the order in which they are printed.
        figures: what the next run is held against, by name.
        plots: SVG by name.
        is_complete: whether all of the section was measured, so that it may be written down.
    """

    tables: Sequence[Table]
    figures: Mapping[str, Figure] = field(default_factory=dict)
    plots: Mapping[str, str] = field(default_factory=dict)
    is_complete: bool = True
