"""`coaxial register points`: paired-point registration of two landmark files."""

import json
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import typer

from server.cli.channel_check import ChannelCheck, check_channel
from server.cli.landmark_rows import LandmarkRows, read_landmarks
from server.cli.registration_form import registration_form
from server.cli.registration_transform import write_transform
from server.config_file import load_config
from server.number_format import finite
from server.point_limits import point_gate, point_settings
from tracker.errors import InvalidInput, RegistrationError
from tracker.geometry import Array
from tracker.registration.points import (
    PointGate,
    PointPairs,
    PointRegistration,
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
    max_left_out_mm: float | None
    max_tre_mm: float | None
    config: Path | None
    transform: Path | None = None
    channel: str | None = None
    tolerance: str | None = None


def register_from_files(options: PointsOptions, *, as_json: bool) -> int:
    """Register and print the result. Return the exit status: 0, or 1 if a limit is exceeded.

    FRE and leave-one-out error have the limits of the settings, as on the server, unless others are given.
    The TRE has no default limit, because a target may lie anywhere; the server's targets are entry points.

    Raises:
        NavigationError: a file cannot be used, or the points do not determine a transform.
    """
    targets = [target_from_text(text) for text in options.targets]
    pairs = pairs_of_files(read_landmarks(options.fixed), read_landmarks(options.moving))
    limits = load_config(options.config).registration
    settings, gate = point_settings(limits), point_gate(limits)
    settings = replace(settings, min_fle_mm=options.min_fle_mm)
    if options.max_left_out_mm is not None:
        settings = replace(settings, max_left_out_mm=options.max_left_out_mm)
    if options.max_fre_mm is not None:
        gate = replace(gate, max_fre_mm=options.max_fre_mm)
    gate = replace(gate, max_tre_mm=np.inf if options.max_tre_mm is None else options.max_tre_mm)
    found = register_points(pairs, excluded=_excluded(options.excluded, pairs), settings=settings)
    failures = found.failures(gate, targets)
    channel = _channel_check(found, options)
    outliers = found.outliers(gate)
    if as_json:
        typer.echo(json.dumps(_mapping(found, targets, gate, failures, channel), allow_nan=False))
    else:
        typer.echo("\n".join(_lines(found, targets, outliers, channel)))
        for remark in found.remarks:
            typer.echo(f"Note: {remark.message}.\n{remark.remedy}", err=True)
    for failure in failures:
        typer.echo(f"Failed: {failure.message}.\n{failure.remedy}", err=True)
    write_transform(options.transform, found.fixed_from_moving, passed=not failures)
    return FAILED if failures else 0


def _channel_check(found: PointRegistration, options: PointsOptions) -> ChannelCheck | None:
    if options.channel is None and options.tolerance is None:
        return None
    if options.channel is None or options.tolerance is None:
        raise InvalidInput(
            "CHANNEL_INCOMPLETE",
            "only one of --channel-mm and --tolerance is given",
            "Give both, from the output of 'coaxial plan measure --json'.",
        )
    return check_channel(found, options.channel, options.tolerance)


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
    found: PointRegistration,
    targets: Sequence[Array],
    gate: PointGate,
    failures: Sequence[RegistrationError],
    channel: ChannelCheck | None,
) -> dict[str, Any]:
    outliers = found.outliers(gate)
    form = registration_form(
        found.fixed_from_moving,
        found.covariance,
        {
            "tre_expected_mm": found.tre_expected_mm,
            "tre_stated_mm": found.tre_stated_mm,
            "tre_without_outlier_mm": found.tre_without_outlier_mm,
        },
        targets,
        floors={"min_fle_mm": found.settings.min_fle_mm},
        limits={
            "max_fre_mm": gate.max_fre_mm,
            "max_left_out_mm": found.settings.max_left_out_mm,
            "max_tre_mm": gate.max_tre_mm,
        },
        remarks=found.remarks,
        failures=failures,
    )
    return {
        **form,
        "fre_rms_mm": found.fre_rms_mm,
        "residuals_mm": found.distances_mm.tolist(),
        "points": [
            {
                "name": label,
                "used": bool(found.used[index]),
                "residual_xyz_mm": found.residuals_mm[index].tolist(),
                "residual_mm": float(found.distances_mm[index]),
                "leave_one_out_mm": found.leave_one_out_mm.get(index),
                "fre_without_mm": found.fre_without_mm.get(index),
                # Null if the other points exclude no error of this one, however large.
                "undetected_mm": finite(found.undetected_mm.get(index)),
                "outlier": index in outliers,
            }
            for index, label in enumerate(found.pairs.labels)
        ],
        "fle_rms_mm": found.fle_mm,
        "scale_ratio": found.scale_ratio,
        "channel": None if channel is None else channel.mapping,
    }


def _lines(
    found: PointRegistration,
    targets: Sequence[Array],
    outliers: Sequence[int],
    channel: ChannelCheck | None,
) -> list[str]:
    left_out = found.leave_one_out_mm
    width = max(5, *(len(label) for label in found.pairs.labels))
    lines = [f"{'point':<{width}}   off mm   x       y       z    left out mm   others fit mm"]
    for index, label in enumerate(found.pairs.labels):
        x, y, z = found.residuals_mm[index]
        alone, others = (
            f"{by[index]:6.2f}" if index in by else "     -" for by in (left_out, found.fre_without_mm)
        )
        note = "" if found.used[index] else "  not used"
        if index in outliers:
            note = "  outlier" if len(outliers) == 1 else "  possible outlier"
            note += ", the likeliest" if len(outliers) > 1 and index == outliers[0] else ""
        lines.append(
            f"{label:<{width}}   {found.distances_mm[index]:6.2f} {x:7.2f} {y:7.2f} {z:7.2f}   "
            f"{alone}        {others}{note}"
        )
    lines += [
        f"Landmarks fit to {found.fre_rms_mm:.2f} mm RMS (FRE); error of a single landmark about "
        f"{found.fle_mm:.2f} mm (FLE). Neither is the error at the target.",
    ]
    for target in targets:
        at = ", ".join(f"{number:g}" for number in target)
        lines.append(
            f"At the target {at} mm: {found.tre_expected_mm(target):.2f} mm expected (TRE, RMS), "
            f"{found.tre_stated_mm(target):.2f} mm stated (includes the uncertainty from few points"
            f"{_outlier_share(found, target)})"
        )
    lines += [] if channel is None else channel.lines
    lines.append("fixed_from_moving:")
    lines += ["  " + " ".join(f"{number:12.6f}" for number in row) for row in found.fixed_from_moving.matrix]
    return lines


def _outlier_share(found: PointRegistration, target: Array) -> str:
    alone = found.tre_without_outlier_mm(target)
    if not found.tre_stated_mm(target) > alone:
        return ""
    return f" and a gross error of one landmark that the others do not exclude; {alone:.2f} mm without it"
