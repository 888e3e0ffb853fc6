"""`coaxial calibrate-rig`: calibrate several cameras from simultaneous images."""

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import typer
import yaml

from server.cli.board_names import BoardOptions
from server.cli.board_options import boards_of, described
from server.cli.calibration.images import files_of
from server.cli.calibration.run import FAILED, DetectedBoards, detect_boards, flattened
from server.cli.output import write_atomically
from server.cli.progress import shown_steps
from server.config_file import load_config
from tracker.camera.calibration import CalibrationReport, calibrate
from tracker.camera.detection import BoardView
from tracker.camera.rig import RigCamera, RigReport, calibrate_rig
from tracker.errors import InvalidInput


@dataclass(frozen=True, slots=True, kw_only=True)
class RigOrder:
    """Options of `coaxial calibrate-rig`."""

    cameras: tuple[str, ...]
    board: BoardOptions
    output: Path | None
    max_rms_px: float | None
    config: Path | None


def calibrate_cameras(order: RigOrder, *, as_json: bool) -> int:
    """Write the rig file and print the report. Return the exit status: 0, or 1 if the RMS is too large.

    Raises:
        NavigationError: Images, board or views cannot be used, or a file cannot be written.
    """
    config = load_config(order.config)
    max_rms_px = config.calibration.max_rms_px if order.max_rms_px is None else order.max_rms_px
    files_from_camera = _files(order.cameras)
    boards = boards_of(order.board)
    with shown_steps() as steps:
        detected = {}
        for name, files in files_from_camera.items():
            detected[name] = detect_boards(files, boards, steps)
            # The properties of the board found with the first camera apply to all.
            boards = detected[name].boards
    reports = {name: _alone(one) for name, one in detected.items()}
    names = next(iter(detected.values())).names
    shots = [
        {name: view for name, one in detected.items() if isinstance(view := one.seen[index][0], BoardView)}
        for index in range(len(names))
    ]
    report = calibrate_rig(shots, reports, names=names)
    passed = report.rms_px <= max_rms_px
    whole = _whole(report, reports)
    if passed and order.output is not None:
        text = yaml.safe_dump({**whole, "boards": [described(board) for board in boards]}, sort_keys=False)
        write_atomically(order.output, text.encode())
    if as_json:
        typer.echo(json.dumps({**whole, "max_rms_px": max_rms_px, "passed": passed}, allow_nan=False))
    else:
        _print_report(report, max_rms_px)
    if not passed:
        typer.echo(
            f"Error: the reprojection error is {report.rms_px:.3f} px RMS, limit {max_rms_px:g} px.\n"
            "Take the images of all cameras at the same instant, or raise the limit with --max-rms-px.",
            err=True,
        )
    return 0 if passed else FAILED


def _files(cameras: Sequence[str]) -> dict[str, list[Path]]:
    """Return the images of each camera; all cameras have the same number of images.

    Raises:
        InvalidInput: RIG_OPTION_INVALID or RIG_IMAGES_UNEVEN.
    """
    found: dict[str, list[Path]] = {}
    for text in cameras:
        name, equals, images = text.partition("=")
        if not equals or not name.strip() or not images or name in found:
            raise InvalidInput(
                "RIG_OPTION_INVALID",
                f"--camera {text} is not of the form NAME=IMAGES, or its name is used twice",
                "Write --camera left=left/ --camera right='right*.png', each with a different name.",
                {"given": text},
            )
        found[name.strip()] = files_of([images])
    counts = {name: len(files) for name, files in found.items()}
    if len(set(counts.values())) > 1:
        raise InvalidInput(
            "RIG_IMAGES_UNEVEN",
            "cameras have different numbers of images: " + ", ".join(f"{n} {c}" for n, c in counts.items()),
            "Give one image of each camera for each instant, in the same order.",
            {"images": counts},
        )
    return found


def _alone(detected: DetectedBoards) -> CalibrationReport:
    views, owners = flattened(detected)
    return calibrate(views, size_wh_px=detected.size_wh_px, names=[detected.names[owner] for owner in owners])


def _whole(report: RigReport, alone: dict[str, CalibrationReport]) -> dict[str, object]:
    return {
        "rms_px": report.rms_px,
        "shared_views": report.shared_shots,
        "cameras": [
            _camera(camera) | {"rms_alone_px": alone[camera.name].rms_px} for camera in report.cameras
        ],
        "views": [
            {
                "image": shot.name,
                "used": list(shot.used),
                "rms_px": None if math.isnan(shot.rms_px) else shot.rms_px,
                "reason": shot.reason,
            }
            for shot in report.shots
        ],
    }


def _camera(camera: RigCamera) -> dict[str, object]:
    return {
        "name": camera.name,
        "matrix": camera.model.matrix.tolist(),
        "distortion": camera.model.distortion.tolist(),
        "size_wh_px": list(camera.model.size_wh_px),
        "camera_from_first": camera.camera_from_first.matrix.tolist(),
        "covariance": camera.covariance.tolist(),
        "baseline_mm": camera.baseline_mm,
        "baseline_sd_mm": camera.baseline_sd_mm,
        "rms_px": camera.rms_px,
    }


def _print_report(report: RigReport, max_rms_px: float) -> None:
    typer.echo(
        f"RMS {report.rms_px:.3f} px (limit {max_rms_px:g} px), {report.shared_shots} of "
        f"{len(report.shots)} views are shared."
    )
    for camera in report.cameras:
        typer.echo(
            f"{camera.name}: RMS {camera.rms_px:.3f} px, {camera.baseline_mm:.3f} mm from the first camera "
            f"(sd {camera.baseline_sd_mm:.3f} mm)"
        )
    for shot in report.shots:
        if shot.reason:
            typer.echo(f"{shot.name}: {shot.reason}")
