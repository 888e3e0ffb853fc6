"""Verify simulated theatres in several processes and report the results."""

import json
import multiprocessing
import os
import sys
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import cv2
from rich.console import Console

from server.cli.progress import shown_steps
from server.cli.verify_plots import plots_of
from server.cli.verify_report import figures_value, row_values, tables_of
from tracker.errors import InvalidInput
from tracker.verification import (
    TheatreRows,
    VerificationSettings,
    drill_figures,
    theatre_seeds,
    verify_theatre,
)

FAILED = 1
MAX_SEED = 2**63


def verify_theatres(
    count: int, *, seed: int, jobs: int | None, as_json: bool, with_rows: bool, plots: Path | None
) -> int:
    """Print errors and coverage. Return the exit status: 0, or 1 if a requirement fails.

    Raises:
        InvalidInput: VERIFY_SEED_INVALID, or OUTPUT_NOT_WRITABLE for the folder of the plots.
    """
    if seed >= MAX_SEED:
        raise InvalidInput(
            "VERIFY_SEED_INVALID", f"the seed is {seed}, the maximum is 2^63 - 1", "Give a smaller seed."
        )
    if plots is not None:
        _create(plots)
    settings = VerificationSettings()
    found = []
    with shown_steps() as steps:
        for theatre in _verified(theatre_seeds(seed, count), jobs or os.cpu_count() or 1):
            found.append(theatre)
            steps.advance("theatres", count)
    figures = drill_figures(found, noticed_within_s=settings.noticed_within_s)
    if plots is not None:
        for name, picture in plots_of(found, figures).items():
            (plots / f"{name}.svg").write_text(picture, encoding="utf-8")
    if as_json:
        value = {"seed": seed, **figures_value(figures, settings)}
        if with_rows:
            value["rows"] = [row for theatre in found for row in row_values(theatre)]
        sys.stdout.write(json.dumps(value, allow_nan=False) + "\n")
    else:
        console = Console(width=None if Console().is_terminal else 150)
        for table in tables_of(figures, settings):
            console.print(table)
        for failure in figures.failures:
            console.print(f"failed: {failure}", style="bold", highlight=False)
    return FAILED if figures.failures else 0


def _verified(seeds: tuple[int, ...], jobs: int) -> Iterator[TheatreRows]:
    """Yield the theatres in the order of their seeds."""
    if jobs == 1 or len(seeds) == 1:
        yield from map(verify_theatre, seeds)
        return
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(min(jobs, len(seeds)), mp_context=context, initializer=_single_threaded) as pool:
        yield from pool.map(verify_theatre, seeds)


def _single_threaded() -> None:
    """Limit OpenCV to one thread, because there is one process per core."""
    cv2.setNumThreads(1)


def _create(folder: Path) -> None:
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InvalidInput(
            "OUTPUT_NOT_WRITABLE",
            f"the folder {folder} cannot be created: {(error.strerror or str(error)).lower()}",
            "Give a folder on a writable disk.",
            {"folder": str(folder)},
        ) from error
