"""Figures for comparison between runs: proportions with counts, sizes with spread."""

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TypeAlias

import numpy as np

FIGURES = Path(__file__).with_name("figures.json")
# By chance, one of some thousand figures is off by this many standard deviations.
NOISE_SD = 3.3
BOOTSTRAPS = 200
# Times of two runs differ by this much on a shared machine, whatever the spread within each.
BETWEEN_RUNS_OF_TIME = 0.08


@dataclass(frozen=True, slots=True, kw_only=True)
class Share:
    """A proportion.

    Attributes:
        is_good: whether more is better.
        is_strict: whether even one more (or less) counts, as for a wrong claim: no chance excuses it.
        in_a_row: images of one sequence that stand or fall together, and so are one look and not many.
    """

    count: int
    of: int
    is_good: bool = True
    is_strict: bool = False
    in_a_row: int = 1

    @property
    def ratio(self) -> float:
        """Return the proportion."""
        return self.count / self.of

    @property
    def range(self) -> tuple[float, float]:
        """Return the confidence interval."""
        return interval(self.count / self.in_a_row, self.of / self.in_a_row)


@dataclass(frozen=True, slots=True, kw_only=True)
class Size:
    """An error, a time or a ratio; lower is better.

    Attributes:
        value: a median or another percentile.
        log_sd: standard deviation of its logarithm, from drawing the same numbers again and again.
        count: how many numbers it comes from.
    """

    value: float
    log_sd: float
    count: int


Figure: TypeAlias = Share | Size


def size_of(values: Sequence[float], percent: float = 50.0, *, is_time: bool = False) -> Size | None:
    """Return a percentile with its spread; None if there are too few values."""
    numbers = np.array([value for value in values if math.isfinite(value) and value > 0.0])
    if len(numbers) < 3:
        return None
    draws = np.random.default_rng(0).choice(numbers, (BOOTSTRAPS, len(numbers)))
    spread = float(np.std(np.log(np.percentile(draws, percent, axis=1))))
    if is_time:
        spread = math.hypot(spread, BETWEEN_RUNS_OF_TIME)
    # The bootstrap underestimates the spread of an extreme percentile of few values.
    spread = max(spread, 1.0 / len(numbers))
    return Size(value=float(np.percentile(numbers, percent)), log_sd=spread, count=len(numbers))


def interval(count: float, of: float, sd: float = NOISE_SD) -> tuple[float, float]:
    """Return the Wilson interval of a proportion."""
    if of == 0:
        return 0.0, 1.0
    p, square = count / of, sd * sd
    middle = (p + square / (2 * of)) / (1.0 + square / of)
    half = sd / (1.0 + square / of) * math.sqrt(p * (1.0 - p) / of + square / (4.0 * of * of))
    return max(middle - half, 0.0), min(middle + half, 1.0)


def is_worse(then: Figure, now: Figure) -> bool:
    """Return whether a figure got worse by more than the noise of both runs."""
    if isinstance(then, Size) and isinstance(now, Size):
        return math.log(now.value / then.value) > NOISE_SD * math.hypot(then.log_sd, now.log_sd)
    if isinstance(then, Share) and isinstance(now, Share) and then.of and now.of:
        good, bad = (then, now) if then.is_good else (now, then)
        fall = good.ratio - bad.ratio
        if now.is_strict:
            return fall > 0.0
        # Newcombe's interval for the difference of two shares: noise, if it reaches zero.
        reach = math.hypot(good.ratio - good.range[0], bad.range[1] - bad.ratio)
        return fall > reach
    return False


def worse_figures(then: Mapping[str, Figure], now: Mapping[str, Figure]) -> list[str]:
    """Return a line for each figure that got worse by more than the noise."""
    return [
        f"{name}: {text_of(now[name])}, was {text_of(then[name])}"
        for name in now
        if name in then and is_worse(then[name], now[name])
    ]


def better_figures(then: Mapping[str, Figure], now: Mapping[str, Figure]) -> list[str]:
    """Return a line for each figure that got better by more than the noise."""
    return [
        f"{name}: {text_of(now[name])}, was {text_of(then[name])}"
        for name in now
        if name in then and is_worse(now[name], then[name])
    ]


def text_of(figure: Figure) -> str:
    """Format a figure."""
    if isinstance(figure, Share):
        share = f"{figure.ratio:.3f}" if figure.of else "none"
        return f"{share} ({figure.count} of {figure.of})"
    return f"{figure.value:.3g} (n {figure.count}, ± {100.0 * figure.log_sd:.0f} %)"


def read_figures(path: Path = FIGURES) -> dict[str, dict[str, Figure]]:
    """Return the written figures by section and name; empty without a file."""
    if not path.exists():
        return {}
    written = json.loads(path.read_text(encoding="utf-8"))
    return {
        section: {name: _figure(values) for name, values in figures.items()}
        for section, figures in written.items()
    }


def write_figures(section: str, figures: Mapping[str, Figure], path: Path = FIGURES) -> None:
    """Write the figures of one section; other sections are preserved."""
    retained = {**read_figures(path), section: figures}
    lines = [
        f" {json.dumps(name)}: {{\n"
        + ",\n".join(f"  {json.dumps(key)}: {json.dumps(_plain(one))}" for key, one in retained[name].items())
        + "\n }"
        for name in sorted(retained)
    ]
    path.write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")


def _plain(figure: Figure) -> dict[str, float]:
    return {
        name: float(f"{value:.4g}") if isinstance(value, float) else value
        for name, value in asdict(figure).items()
    }


def _figure(values: Mapping[str, float | bool]) -> Figure:
    if "value" in values:
        return Size(value=float(values["value"]), log_sd=float(values["log_sd"]), count=int(values["count"]))
    return Share(
        count=int(values["count"]),
        of=int(values["of"]),
        is_good=bool(values["is_good"]),
        is_strict=bool(values["is_strict"]),
        in_a_row=int(values.get("in_a_row", 1)),
    )
