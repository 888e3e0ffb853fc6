"""Errors of the pedicle measurement against their stated standard deviations, by bone and scan."""

import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
import scipy

from tests.benchmarks.tables import Table
from tracker.errors import NavigationError
from tracker.geometry import rotation_from_vector
from tracker.plan import Volume, measure_pedicle
from tracker.plan.pedicle import sagittal_deg_of, transverse_deg_of
from tracker.rehearsal.ct import ScanGrid, VertebraPhantom, random_phantom, scan

PHANTOMS = 4
QUANTITIES = ("width mm", "height mm", "length mm", "transverse deg", "sagittal deg")
TEXTURE_MM, TEXTURE_CELLS = 1.5, 64
STREAKS, STREAK_HU_MM = 9.0, 900.0
SCREW_HU, SCREW_RADIUS_MM = 8000.0, 2.5


@dataclass(frozen=True, slots=True, kw_only=True)
class Condition:
    """Bone and scan of one row; `trabecular_hu` is the sd of the marrow's texture."""

    name: str
    cortex_mm: float = 1.0
    cortex_hu: float = 900.0
    marrow_hu: float = 160.0
    trabecular_hu: float = 40.0
    turn_deg: float = 0.0
    tilt_deg: float = 0.0
    spacing_mm: tuple[float, float, float] = (0.6, 0.6, 1.0)
    has_screw: bool = False


CONDITIONS = (
    Condition(name="0.6 mm, 1 mm slices"),
    Condition(name="0.5 mm voxels", spacing_mm=(0.5, 0.5, 0.5)),
    Condition(name="1.5 mm voxels", spacing_mm=(1.5, 1.5, 1.5)),
    Condition(name="3 mm slices", spacing_mm=(0.6, 0.6, 3.0)),
    Condition(name="cortex 0.6 mm", cortex_mm=0.6),
    Condition(name="osteoporosis, 0.5 mm cortex", cortex_mm=0.5, cortex_hu=600.0, marrow_hu=30.0),
    Condition(
        name="osteoporosis, 1.5 mm voxels",
        cortex_mm=0.5,
        cortex_hu=600.0,
        marrow_hu=30.0,
        spacing_mm=(1.5, 1.5, 1.5),
    ),
    Condition(name="sclerosis", cortex_mm=1.5, marrow_hu=450.0, trabecular_hu=80.0),
    Condition(name="screw on the other side", has_screw=True),
    Condition(name="scoliosis, turned by 30 deg", turn_deg=30.0),
    Condition(name="gantry tilt 15 deg", tilt_deg=15.0),
)


@dataclass(slots=True)
class _Found:
    errors: list[list[float]] = field(default_factory=list)
    sds: list[list[float]] = field(default_factory=list)
    codes: list[str] = field(default_factory=list)
    seconds: list[float] = field(default_factory=list)


def condition_tables(phantoms: int = PHANTOMS) -> list[Table]:
    """Return the tables of errors, and of errors divided by their stated sd, one row a condition."""
    errors, ratios = [], []
    for condition in CONDITIONS:
        found = _measured(condition, phantoms)
        error = np.array(found.errors).reshape(-1, len(QUANTITIES))
        z = error / np.array(found.sds).reshape(error.shape)
        if not len(error):
            error = z = np.full((1, len(QUANTITIES)), np.nan)
        counts = [str(len(found.errors)), " ".join(sorted(found.codes)) or "0"]
        sizes = zip(np.median(np.abs(error), axis=0), np.percentile(np.abs(error), 95.0, axis=0), strict=True)
        errors.append(
            [
                condition.name,
                *counts,
                *(f"{one:.2f} / {largest:.2f}" for one, largest in sizes),
                f"{max(found.seconds):.1f}",
            ]
        )
        covered = [_coverage_text(column) for column in np.abs(z).T]
        rms = np.sqrt(np.mean(z**2, axis=0))
        ratios.append([condition.name, *(f"{one:.2f}, {two}" for one, two in zip(rms, covered, strict=True))])
    return [
        Table(
            title="Error by condition, median / 95 %",
            columns=["condition", "measured", "refused", *QUANTITIES, "slowest click s"],
            rows=errors,
            note="The time is that of the processor.",
        ),
        Table(
            title="Error divided by its stated standard deviation",
            columns=["condition", *QUANTITIES],
            rows=ratios,
            note="RMS, and the share within 1.96 sd with its lower 95 % confidence bound (Clopper-Pearson).",
        ),
    ]


def _coverage_text(ratios: np.ndarray) -> str:
    covered, count = int((ratios <= 1.96).sum()), len(ratios)
    bound = float(scipy.stats.beta.ppf(0.05, covered, count - covered + 1)) if covered else 0.0
    return f"{covered}/{count} (> {100.0 * bound:.0f} %)"


def _measured(condition: Condition, phantoms: int) -> _Found:
    found = _Found()
    for seed in range(1, phantoms + 1):
        made = _vertebra(condition, seed)
        volume = _scanned(made, condition, "left", seed)
        for side in ("left", "right"):
            if condition.has_screw and side == "right":
                volume = _scanned(made, condition, side, seed)
            aside = np.random.default_rng(seed).uniform(-1.0, 1.0, 3)
            click = made.seed_lps_mm(side, (3.0 * aside[0], aside[1], aside[2]))
            truth = made.truth(side)
            start = time.process_time()
            try:
                one = measure_pedicle(volume, click, side)
            except NavigationError as error:
                found.codes.append(error.code)
                continue
            finally:
                found.seconds.append(time.process_time() - start)
            found.errors.append(
                [
                    one.width_mm - truth.width_mm,
                    one.height_mm - truth.height_mm,
                    one.length_mm - truth.length_mm,
                    one.transverse_deg - transverse_deg_of(truth.axis_lps, one.side),
                    one.sagittal_deg - sagittal_deg_of(truth.axis_lps),
                ]
            )
            sd = one.sd
            found.sds.append([sd.width_mm, sd.height_mm, sd.length_mm, sd.transverse_deg, sd.sagittal_deg])
    return found


def _vertebra(condition: Condition, seed: int) -> VertebraPhantom:
    made = random_phantom(seed)
    turn = rotation_from_vector(np.radians(condition.turn_deg) * np.array([0.0, 0.0, 1.0]))
    return replace(
        made,
        cortex_mm=condition.cortex_mm,
        cortex_hu=condition.cortex_hu,
        marrow_hu=condition.marrow_hu,
        rotation=turn @ made.rotation,
    )


def _scanned(made: VertebraPhantom, condition: Condition, side: str, seed: int) -> Volume:
    grid = ScanGrid.around(
        made.rotation @ np.array([0.0, -8.0, 0.0]) + made.place_mm,
        size_mm=(84.0, 104.0, 48.0),
        spacing_mm=condition.spacing_mm,
        gantry_tilt_deg=condition.tilt_deg,
        blur_mm=0.4,
        noise_hu=25.0,
        seed=seed,
    )
    grid = replace(grid, samples=(3, 3, 5))
    other = "right" if side == "left" else "left"
    return scan(_hu_at(made, condition, other if condition.has_screw else None, seed), grid)


def _hu_at(
    made: VertebraPhantom, condition: Condition, screw: str | None, seed: int
) -> Callable[[np.ndarray], np.ndarray]:
    """Return the phantom's HU with trabecular texture in the marrow, and a screw with its streaks."""
    white = np.random.default_rng(seed).normal(size=(TEXTURE_CELLS,) * 3)
    truth = None if screw is None else made.truth(screw)

    def hu_at(points: np.ndarray) -> np.ndarray:
        hu = made.hu_at(points)
        marrow = np.flatnonzero(hu == made.marrow_hu)
        cells = (points[marrow] - made.place_mm) / TEXTURE_MM
        hu[marrow] += condition.trabecular_hu * scipy.ndimage.map_coordinates(
            white, cells.T, order=1, mode="grid-wrap"
        )
        if truth is not None:
            local = points - truth.isthmus_lps_mm
            along = local @ truth.axis_lps
            radius = np.linalg.norm(local - along[:, None] * truth.axis_lps, axis=1)
            angle = np.arctan2(local[:, 1], local[:, 0])
            hu += STREAK_HU_MM * np.cos(STREAKS * angle) / np.maximum(np.hypot(local[:, 0], local[:, 1]), 4.0)
            hu[(radius < SCREW_RADIUS_MM) & (np.abs(along) < 20.0)] = SCREW_HU
        return hu

    return hu_at
