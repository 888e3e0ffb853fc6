"""`coaxial register surface`: register a swept point cloud to the mesh of the bone."""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import typer

from server.cli.landmark_rows import read_landmarks
from server.cli.register import FAILED, pairs_of_files, target_from_text
from server.cli.registration_form import registration_form
from server.cli.registration_transform import write_transform
from server.config import RegistrationConfig
from server.config_file import load_config
from server.imaging.meshes import read_mesh
from server.point_limits import point_gate, point_settings
from server.slicer_file import fixed_from_moving_in_itk, is_itk_name
from tracker.errors import InvalidInput, RegistrationError, Remark
from tracker.geometry import Anchor, Array, Rigid, Vertebra
from tracker.registration.points import PointPairs, register_points
from tracker.registration.surface import (
    ClosestPointQuery,
    SurfaceGate,
    SurfaceRegistration,
    SurfaceSettings,
    register_surface,
)

START_REMEDY = (
    "Give landmarks with --fixed and --moving, or with --start a transform of ITK (.tfm) or a JSON file "
    "with a 4x4 matrix, such as the output of 'coaxial register points --json'."
)


@dataclass(frozen=True, slots=True, kw_only=True)
class SurfaceOptions:
    """Options of `coaxial register surface`."""

    surface: Path
    unit: str | None
    points: Path
    start: Path | None
    fixed: Path | None
    moving: Path | None
    targets: Sequence[str]
    tip_radius_mm: float
    config: Path | None
    transform: Path | None = None


def register_sweep(options: SurfaceOptions, *, as_json: bool) -> int:
    """Register the sweep to the surface and print the result. Return 0, or 1 if a limit is exceeded.

    The RMS distance has the limit of the settings, as on the server.

    Raises:
        NavigationError: a file cannot be used, or the sweep does not determine the registration.
    """
    targets = [target_from_text(text) for text in options.targets]
    limits = load_config(options.config).registration
    start, landmarks = _start(options, limits)
    mesh = read_mesh(options.surface, unit=options.unit)
    settings = SurfaceSettings(tip_radius_mm=options.tip_radius_mm)
    # No limit for the TRE, because a target may lie anywhere; the server's targets are entry points.
    gate = SurfaceGate(max_rms_mm=limits.max_surface_rms_mm, max_tre_mm=np.inf)
    found = register_surface(
        ClosestPointQuery(mesh.surface),
        read_landmarks(options.points).points_mm,
        start,
        targets_mm=targets,
        landmarks=landmarks,
        settings=settings,
    )
    remarks = (*mesh.remarks, *found.remarks)
    failures = found.failures(gate, targets)
    if as_json:
        typer.echo(json.dumps(_mapping(found, targets, settings, gate, remarks, failures), allow_nan=False))
    else:
        typer.echo("\n".join(_lines(found, targets)))
        for remark in remarks:
            typer.echo(f"Note: {remark.message}.\n{remark.remedy}", err=True)
    for failure in failures:
        typer.echo(f"Failed: {failure.message}.\n{failure.remedy}", err=True)
    write_transform(options.transform, found.fixed_from_moving, passed=not failures)
    return FAILED if failures else 0


def _start(
    options: SurfaceOptions, limits: RegistrationConfig
) -> tuple[Rigid[Vertebra, Anchor], PointPairs | None]:
    """Return the initial transform, and the landmarks that also enter the fit; none with --start.

    Raises:
        InvalidInput: REGISTRATION_START_MISSING or REGISTRATION_START_INVALID.
        RegistrationError: as `register_points`; or POINTS_FIT_TOO_LARGE or POINT_STRAYS, the landmarks exceed
            the limits of the settings.
    """
    if options.start is not None and options.fixed is None and options.moving is None:
        return _matrix(options.start), None
    if options.start is not None or options.fixed is None or options.moving is None:
        raise InvalidInput(
            "REGISTRATION_START_MISSING",
            "two initial transforms are given" if options.start else "no initial transform is given",
            START_REMEDY,
        )
    pairs = pairs_of_files(read_landmarks(options.fixed), read_landmarks(options.moving))
    found = register_points(pairs, settings=point_settings(limits))
    # Their TRE is not limited, because the sweep reduces it.
    for failure in found.failures(point_gate(limits), ()):
        raise failure
    return found.fixed_from_moving, pairs


def _matrix(path: Path) -> Rigid[Vertebra, Anchor]:
    if is_itk_name(path.name):
        return fixed_from_moving_in_itk(_bytes(path), name=str(path))
    try:
        given = json.loads(path.read_text(encoding="utf-8-sig"))
        matrix = np.array(given["fixed_from_moving"] if isinstance(given, dict) else given, dtype=np.float64)
    except (OSError, ValueError, KeyError, TypeError, RecursionError) as error:
        raise InvalidInput(
            "REGISTRATION_START_INVALID",
            f"{path} contains no readable 4x4 matrix",
            START_REMEDY,
            {"file": str(path)},
        ) from error
    if matrix.shape != (4, 4) or not np.allclose(matrix[3], [0.0, 0.0, 0.0, 1.0]):
        raise InvalidInput(
            "REGISTRATION_START_INVALID",
            f"{path} has a matrix of shape {matrix.shape}, expected (4, 4) with 0 0 0 1 in the last row",
            START_REMEDY,
            {"file": str(path)},
        )
    return Rigid.from_matrix(matrix)


def _bytes(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise InvalidInput(
            "REGISTRATION_START_INVALID",
            f"{path} cannot be read: {(error.strerror or str(error)).lower()}",
            START_REMEDY,
            {"file": str(path)},
        ) from error


def _mapping(
    found: SurfaceRegistration,
    targets: Sequence[Array],
    settings: SurfaceSettings,
    gate: SurfaceGate,
    remarks: Sequence[Remark],
    failures: Sequence[RegistrationError],
) -> dict[str, Any]:
    form = registration_form(
        found.fixed_from_moving,
        found.covariance,
        {"tre_expected_mm": found.tre_expected_mm, "tre_stated_mm": found.tre_stated_mm},
        targets,
        floors={"min_sd_mm": settings.min_sd_mm},
        limits={
            "max_rms_mm": gate.max_rms_mm,
            "max_moved_mm": gate.max_moved_mm,
            "max_tre_mm": gate.max_tre_mm,
        },
        remarks=remarks,
        failures=failures,
    )
    return {
        **form,
        "rms_mm": found.rms_mm,
        "used_ratio": found.used_ratio,
        "used": found.used.tolist(),
        "off_mm": found.off_mm.tolist(),
        "moved_mm": found.moved_mm,
        "moved_deg": found.moved_deg,
        "weakest": {
            "direction": found.weakest_mode.description,
            "sd_mm": min(found.weakest_mode.sd_mm, 1000.0),
        },
    }


def _lines(found: SurfaceRegistration, targets: Sequence[Array]) -> list[str]:
    lines = [
        f"{found.used_ratio:.0%} of {len(found.used)} swept points lie on the bone, "
        f"to {found.rms_mm:.2f} mm RMS",
        f"Moved by {found.moved_mm:.1f} mm and {found.moved_deg:.1f} deg from the initial transform",
        f"Least certain direction: {found.weakest_mode.description}",
    ]
    for target in targets:
        at = ", ".join(f"{number:g}" for number in target)
        lines.append(
            f"At the target {at} mm: {found.tre_expected_mm(target):.2f} mm expected (TRE, RMS), "
            f"{found.tre_stated_mm(target):.2f} mm stated (not below a floor, larger for few points)"
        )
    lines.append("fixed_from_moving:")
    lines += ["  " + " ".join(f"{number:12.6f}" for number in row) for row in found.fixed_from_moving.matrix]
    return lines
