"""`coaxial register surface`: a sweep of the tip, laid on the mesh of the bone."""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import typer

from server.cli.landmark_rows import read_landmarks
from server.cli.register import pairs_of_files, target_from_text
from server.imaging.meshes import read_mesh
from tracker.errors import InvalidInput
from tracker.geometry import Anchor, Array, Rigid, Vertebra
from tracker.plan.remark import Remark
from tracker.registration.points import PairedPoints, register_points
from tracker.registration.surface import (
    NearestOnSurface,
    SurfaceRegistration,
    SurfaceSettings,
    register_surface,
)

START_REMEDY = (
    "Give landmarks with --fixed and --moving, or with --start a JSON file with a 4x4 matrix: what "
    "'coaxial register points --json' wrote will do."
)


@dataclass(frozen=True, slots=True, kw_only=True)
class SurfaceOrder:
    """What was typed; see the options of `coaxial register surface`."""

    surface: Path
    unit: str | None
    points: Path
    start: Path | None
    fixed: Path | None
    moving: Path | None
    targets: Sequence[str]
    tip_radius_mm: float


def register_sweep(order: SurfaceOrder, *, as_json: bool) -> None:
    """Lay the sweep on the surface and tell it.

    Raises:
        NavigationError: a file cannot be used, or the sweep does not say where the bone is.
    """
    targets = [target_from_text(text) for text in order.targets]
    start, landmarks = _start(order)
    mesh = read_mesh(order.surface, unit=order.unit)
    found = register_surface(
        NearestOnSurface(mesh.surface),
        read_landmarks(order.points).points_mm,
        start,
        targets_mm=targets,
        landmarks=landmarks,
        settings=SurfaceSettings(tip_radius_mm=order.tip_radius_mm),
    )
    remarks = (*mesh.remarks, *found.remarks)
    if as_json:
        typer.echo(json.dumps(_mapping(found, targets, remarks), allow_nan=False))
        return
    typer.echo("\n".join(_lines(found, targets)))
    for remark in remarks:
        typer.echo(f"Note: {remark.message}.\n{remark.remedy}", err=True)


def _start(order: SurfaceOrder) -> tuple[Rigid[Vertebra, Anchor], PairedPoints | None]:
    """Where to begin, and the landmarks that pull too; a start from a file pulls no more."""
    if order.start is not None and order.fixed is None and order.moving is None:
        return _matrix(order.start), None
    if order.start is not None or order.fixed is None or order.moving is None:
        raise InvalidInput(
            "REGISTRATION_START_MISSING",
            "where the bone is roughly is said twice"
            if order.start
            else "nothing says where the bone is roughly",
            START_REMEDY,
        )
    pairs = pairs_of_files(read_landmarks(order.fixed), read_landmarks(order.moving))
    return register_points(pairs).fixed_from_moving, pairs


def _matrix(path: Path) -> Rigid[Vertebra, Anchor]:
    try:
        given = json.loads(path.read_text(encoding="utf-8-sig"))
        matrix = np.array(given["fixed_from_moving"] if isinstance(given, dict) else given, dtype=np.float64)
    except (OSError, ValueError, KeyError, TypeError, RecursionError) as error:
        raise InvalidInput(
            "REGISTRATION_START_INVALID",
            f"{path} has no 4x4 matrix that can be read",
            START_REMEDY,
            {"file": str(path)},
        ) from error
    if matrix.shape != (4, 4) or not np.allclose(matrix[3], [0.0, 0.0, 0.0, 1.0]):
        raise InvalidInput(
            "REGISTRATION_START_INVALID",
            f"{path} has a matrix of shape {matrix.shape}, needed (4, 4) with 0 0 0 1 in the last row",
            START_REMEDY,
            {"file": str(path)},
        )
    return Rigid.from_matrix(matrix)


def _mapping(
    found: SurfaceRegistration, targets: Sequence[Array], remarks: Sequence[Remark]
) -> dict[str, Any]:
    stated = [found.tre_stated_mm(target) for target in targets]
    return {
        "fixed_from_moving": found.fixed_from_moving.matrix.tolist(),
        "rms_mm": found.rms_mm,
        "used_ratio": found.used_ratio,
        "used": found.used.tolist(),
        "off_mm": found.off_mm.tolist(),
        "moved_mm": found.moved_mm,
        "moved_deg": found.moved_deg,
        "tre_expected_mm": stated[0] if len(stated) == 1 else (stated or None),
        "weakest": {"direction": found.weakest.in_words, "sd_mm": min(found.weakest.sd_mm, 1000.0)},
        "covariance": found.covariance.tolist(),
        "warnings": [{"code": one.code, "message": one.message, "remedy": one.remedy} for one in remarks],
    }


def _lines(found: SurfaceRegistration, targets: Sequence[Array]) -> list[str]:
    lines = [
        f"{found.used_ratio:.0%} of {len(found.used)} swept points lie on the bone, "
        f"to {found.rms_mm:.2f} mm RMS",
        f"It moved by {found.moved_mm:.1f} mm and {found.moved_deg:.1f} deg from its start",
        f"Least sure: {found.weakest.in_words}",
    ]
    for target in targets:
        at = ", ".join(f"{number:g}" for number in target)
        lines.append(f"At the target {at} mm: {found.tre_stated_mm(target):.2f} mm expected (TRE, RMS)")
    lines.append("fixed_from_moving:")
    lines += ["  " + " ".join(f"{number:12.6f}" for number in row) for row in found.fixed_from_moving.matrix]
    return lines
