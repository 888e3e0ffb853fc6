"""`coaxial register points`: paired-point registration of two landmark files."""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import typer

from server.cli.landmark_rows import LandmarkRows, read_landmarks
from tracker.errors import InvalidInput, RegistrationError
from tracker.geometry import Array
from tracker.plan.remark import Remark
from tracker.registration.points import (
    PointGate,
    PointPairs,
    PointRegistration,
    PointSettings,
    register_points,
)

FAILED = 1


@dataclass(frozen=True, slots=True, kw_only=True)
class PointsOptions:
    """Options of `coaxial register points`."""

    fixed: Path
    moving: Path
    targets: Sequence[str]
    excluded: Sequence[str]
    min_fle_mm: float
    max_fre_mm: float | None
    max_tre_mm: float | None


def register_from_files(options: PointsOptions, *, as_json: bool) -> int:
    """Register and print the result. Return the exit status: 0, or 1 if a given limit is exceeded.

    Raises:
        NavigationError: a file cannot be used, or the points do not determine a transform.
    """
    targets = [target_from_text(text) for text in options.targets]
    pairs = pairs_of_files(read_landmarks(options.fixed), read_landmarks(options.moving))
    settings = PointSettings(min_fle_mm=options.min_fle_mm)
    found = register_points(pairs, excluded=_excluded(options.excluded, pairs), settings=settings)
    failures = found.failures(
        PointGate(
            max_fre_mm=np.inf if options.max_fre_mm is None else options.max_fre_mm,
            max_tre_mm=np.inf if options.max_tre_mm is None else options.max_tre_mm,
        ),
        targets,
    )
    if as_json:
        typer.echo(json.dumps(_mapping(found, targets, failures), allow_nan=False))
    else:
        typer.echo("\n".join(_lines(found, targets)))
        for remark in found.remarks:
            typer.echo(f"Note: {remark.message}.\n{remark.remedy}", err=True)
    for failure in failures:
        typer.echo(f"Failed: {failure.message}.\n{failure.remedy}", err=True)
    return FAILED if failures else 0


def target_from_text(text: str) -> Array:
    """Parse `x,y,z`, separated by commas or blanks.

    Raises:
        InvalidInput: TARGET_INVALID.
    """
    try:
        target = np.array([float(word) for word in text.strip("[]() ").replace(",", " ").split()])
    except ValueError:
        target = np.empty(0)
    if target.shape != (3,) or not np.isfinite(target).all():
        raise InvalidInput(
            "TARGET_INVALID",
            f"--target-mm is '{text}', expected three numbers",
            "Give x,y,z in mm in the frame of the fixed points, as --target-mm=-12.5,40,-803.",
            {"target_mm": text},
        )
    return target


def pairs_of_files(fixed: LandmarkRows, moving: LandmarkRows) -> PointPairs:
    """Pair the points of both files, by name if both have names, otherwise by order."""
    if not (fixed.labels and moving.labels):
        labels = fixed.labels or moving.labels
        same = len(fixed.points_mm) == len(moving.points_mm)
        return PointPairs(fixed_mm=fixed.points_mm, moving_mm=moving.points_mm, labels=labels if same else ())
    alone = sorted(set(fixed.labels) ^ set(moving.labels))
    if alone:
        raise RegistrationError(
            "POINTS_NAMES_DIFFER",
            f"the points {', '.join(alone[:6])} are in only one of the two files",
            "Give each landmark the same name in both files, or remove it from both.",
            {"alone": alone, "fixed": len(fixed.labels), "moving": len(moving.labels)},
        )
    order = [moving.labels.index(label) for label in fixed.labels]
    return PointPairs(fixed_mm=fixed.points_mm, moving_mm=moving.points_mm[order], labels=fixed.labels)


def _excluded(names: Sequence[str], pairs: PointPairs) -> list[int]:
    unknown = [name for name in names if name not in pairs.labels]
    if unknown:
        raise InvalidInput(
            "POINTS_NAME_UNKNOWN",
            f"there is no point '{unknown[0]}', known points are {', '.join(pairs.labels)}",
            "Give a name from the files, or the number of the point if they have no names.",
        )
    return [pairs.labels.index(name) for name in names]


def _mapping(
    found: PointRegistration, targets: Sequence[Array], failures: Sequence[RegistrationError]
) -> dict[str, Any]:
    tre = [found.tre_expected_mm(target) for target in targets]
    left_out = found.leave_one_out_mm
    return {
        "fixed_from_moving": found.fixed_from_moving.matrix.tolist(),
        "fre_rms_mm": found.fre_rms_mm,
        "residuals_mm": found.distances_mm.tolist(),
        # A number for one target, a list for several, null without a target.
        "tre_expected_mm": tre[0] if len(tre) == 1 else (tre or None),
        "targets": [
            {
                "target_mm": target.tolist(),
                "tre_expected_mm": expected,
                "tre_stated_mm": found.tre_stated_mm(target),
            }
            for target, expected in zip(targets, tre, strict=True)
        ],
        "points": [
            {
                "name": label,
                "used": bool(found.used[index]),
                "residual_xyz_mm": found.residuals_mm[index].tolist(),
                "residual_mm": float(found.distances_mm[index]),
                "leave_one_out_mm": left_out.get(index),
            }
            for index, label in enumerate(found.pairs.labels)
        ],
        "fle_rms_mm": found.fle_mm,
        "scale_ratio": found.scale_ratio,
        "covariance": found.covariance.tolist(),
        "covariance_of": "fixed_from_moving [mm, rad]: translation, then a small left-multiplied rotation",
        "warnings": [_failure_value(remark) for remark in found.remarks],
        "gate": {"passed": not failures, "failures": [_failure_value(failure) for failure in failures]},
    }


def _failure_value(failure: Remark | RegistrationError) -> dict[str, str]:
    return {"code": failure.code, "message": failure.message, "remedy": failure.remedy}


def _lines(found: PointRegistration, targets: Sequence[Array]) -> list[str]:
    left_out = found.leave_one_out_mm
    width = max(5, *(len(label) for label in found.pairs.labels))
    lines = [f"{'point':<{width}}   off mm   x       y       z    left out mm"]
    for index, label in enumerate(found.pairs.labels):
        x, y, z = found.residuals_mm[index]
        alone = f"{left_out[index]:6.2f}" if index in left_out else "     -"
        note = "" if found.used[index] else "  not used"
        lines.append(
            f"{label:<{width}}   {found.distances_mm[index]:6.2f} {x:7.2f} {y:7.2f} {z:7.2f}   {alone}{note}"
        )
    lines += [
        f"Landmarks fit to {found.fre_rms_mm:.2f} mm RMS (FRE); error of a single landmark about "
        f"{found.fle_mm:.2f} mm (FLE). Neither is the error at the target.",
    ]
    for target in targets:
        at = ", ".join(f"{number:g}" for number in target)
        lines.append(
            f"At the target {at} mm: {found.tre_expected_mm(target):.2f} mm expected (TRE, RMS), "
            f"{found.tre_stated_mm(target):.2f} mm stated (includes the uncertainty from few points)"
        )
    lines.append("fixed_from_moving:")
    lines += ["  " + " ".join(f"{number:12.6f}" for number in row) for row in found.fixed_from_moving.matrix]
    return lines
