"""`coaxial calibrate`: detect boards in images, calibrate a camera, and write its file and report."""

from collections.abc import Sequence
from dataclasses import dataclass
from hashlib import blake2b
from pathlib import Path

import typer

from server.calibration import coverage_svg, residuals_svg
from server.camera_file import CameraFile, camera_file_text
from server.cli.board_names import SIZE_COUNTS, BoardOptions
from server.cli.board_options import boards_of, described
from server.cli.calibration.images import Picture, Unusable, files_of, names_of, read_picture, usual_size
from server.cli.calibration.reported import ImageEntry, Sight, entries_of, json_of, print_report
from server.cli.output import write_atomically
from server.cli.progress import Steps, shown_steps
from server.config_file import load_config
from tracker.camera import Board
from tracker.camera.calibration import (
    CalibrationReport,
    CalibrationSettings,
    calibrate,
    with_board_size_warning,
)
from tracker.camera.detection import BoardNotFound, BoardView, board_as_seen, find_board
from tracker.errors import CalibrationError, InvalidInput

FAILED = 1
# Images from which unspecified properties of a board are determined.
MAX_TRIAL_IMAGES = 8


@dataclass(frozen=True, slots=True, kw_only=True)
class CalibrationOrder:
    """Options of `coaxial calibrate`."""

    images: tuple[str, ...]
    board: BoardOptions
    output: Path | None
    plots: Path | None
    camera_name: str | None
    camera_source: str | None
    coefficients: int | None
    max_rms_px: float | None
    config: Path | None


@dataclass(frozen=True, slots=True, kw_only=True)
class DetectedBoards:
    """Boards found in the images.

    Attributes:
        boards: The boards, with the properties determined from the images.
        names: Names of the images.
        seen: For each image and board a view, or why there is none; one reason for an unusable image.
        size_wh_px: Size of all images.
    """

    boards: tuple[Board, ...]
    names: tuple[str, ...]
    seen: tuple[Sight, ...]
    size_wh_px: tuple[int, int]


def calibrate_camera(order: CalibrationOrder, *, as_json: bool) -> int:
    """Write the camera file and print the report. Return the exit status: 0, or 1 if the RMS is too large.

    Raises:
        NavigationError: The images, the board or the views cannot be used, no lens model fits them, or a
            file cannot be written.
    """
    config = load_config(order.config)
    max_rms_px = config.calibration.max_rms_px if order.max_rms_px is None else order.max_rms_px
    boards = boards_of(order.board)
    files = files_of(order.images)
    _reject_writing_over(order.output, files)
    with shown_steps() as steps:
        detected = detect_boards(files, boards, steps)
    views, owners = flattened(detected)
    report = calibrate(
        views,
        size_wh_px=detected.size_wh_px,
        names=[detected.names[owner] for owner in owners],
        settings=CalibrationSettings(coefficients=order.coefficients),
    )
    for at, board in enumerate(detected.boards):
        shown = [sight[at] for sight in detected.seen if at < len(sight)]
        report = with_board_size_warning(report, [one for one in shown if isinstance(one, BoardView)], board)
    entries = entries_of(detected.names, detected.seen, report)
    passed = report.rms_px <= max_rms_px
    if passed:
        # Checked before a file is written, because all other commands would reject the file.
        report.camera.require_plausible()
    written = _write(order, report, entries, detected.boards) if passed else ()
    if as_json:
        typer.echo(
            json_of(
                report,
                entries,
                boards=[described(board) for board in detected.boards],
                more={"max_rms_px": max_rms_px, "passed": passed, "files": [str(one) for one in written]},
            )
        )
    else:
        print_report(report, entries, max_rms_px=max_rms_px)
        if written:
            typer.echo(f"Wrote {', '.join(map(str, written))}.")
        if passed and order.output is None:
            typer.echo("No camera file was written. To write one, give --output camera.yaml.")
    if not passed:
        typer.echo(
            f"Error: the reprojection error is {report.rms_px:.3f} px RMS, limit {max_rms_px:g} px.\n"
            "Take sharp images of a flat, stiff board, or raise the limit with --max-rms-px.",
            err=True,
        )
    return 0 if passed else FAILED


def detect_boards(files: Sequence[Path], boards: Sequence[Board], steps: Steps) -> DetectedBoards:
    """Search every image for every board; unreadable images and those of another size are unusable.

    Raises:
        InvalidInput: IMAGE_UNREADABLE, no image is readable.
        CalibrationError: IMAGE_SIZES_DIFFER, no size is in the majority.
    """
    names = names_of(files)
    every = max(1, len(files) // MAX_TRIAL_IMAGES)
    some = {n: read_picture(files[n], names[n]) for n in range(0, len(files), every)[:MAX_TRIAL_IMAGES]}
    first = [one.image for one in some.values() if isinstance(one, Picture)]
    seen_boards = tuple(board_as_seen(first, board) for board in boards)
    seen: list[Sight] = []
    size_of: dict[str, tuple[int, int]] = {}
    name_of: dict[bytes, str] = {}
    for n, (file, name) in enumerate(zip(files, names, strict=True)):
        steps.advance("detecting the board", len(files))
        # Each image is decoded once; the images decoded above are released one by one.
        one = some.pop(n) if n in some else read_picture(file, name)
        if isinstance(one, Picture):
            twin = name_of.setdefault(blake2b(one.image.tobytes()).digest(), name)
            if twin != name:
                one = Unusable(name=name, sentence=f"duplicate of {twin}, counted once")
        if isinstance(one, Unusable):
            seen.append((one,))
            continue
        size_of[name] = (one.image.shape[1], one.image.shape[0])
        seen.append(tuple(_found(one, board) for board in seen_boards))
    size = usual_size(size_of, [one for sight in seen for one in sight if isinstance(one, Unusable)])
    return DetectedBoards(
        boards=seen_boards,
        names=tuple(names),
        seen=tuple(
            sight if size_of.get(name, size) == size else (_other_size(name, size_of[name], size),)
            for name, sight in zip(names, seen, strict=True)
        ),
        size_wh_px=size,
    )


def _other_size(name: str, size: tuple[int, int], usual: tuple[int, int]) -> Unusable:
    return Unusable(
        name=name,
        sentence=f"it has {size[0]}x{size[1]} px, but most images have {usual[0]}x{usual[1]} px",
    )


def flattened(detected: DetectedBoards) -> tuple[list[BoardView], list[int]]:
    """Return all views, and for each the index of its image.

    Raises:
        CalibrationError: BOARD_NOT_FOUND, no image shows the board.
    """
    views, owners = [], []
    for index, found in enumerate(detected.seen):
        for one in found:
            if isinstance(one, BoardView):
                views.append(one)
                owners.append(index)
    if not views:
        at, why = next(
            (at, one)
            for at, found in enumerate(detected.seen)
            for one in found
            if isinstance(one, BoardNotFound)
        )
        raise CalibrationError(
            "BOARD_NOT_FOUND",
            f"the board was found in none of {len(detected.names)} images "
            f"({detected.names[at]}: {why.sentence})",
            f"Check --pattern and --size ({SIZE_COUNTS}), and that the board is sharp and evenly lit.",
            {"images": len(detected.names), "reason": why.reason.value},
        )
    return views, owners


def _found(picture: Picture, board: Board) -> BoardView | BoardNotFound:
    return find_board(picture.image, board)


def _write(
    order: CalibrationOrder, report: CalibrationReport, entries: Sequence[ImageEntry], boards: Sequence[Board]
) -> tuple[Path, ...]:
    written: list[Path] = []
    if order.output is not None:
        file = CameraFile(
            model=report.camera, camera_name=order.camera_name, camera_source=order.camera_source
        )
        facts = {
            "rms_px": round(report.rms_px, 4),
            "sd": {one.name: float(f"{one.sd:.4g}") for one in report.parameters},
            "views_used": sum(entry.used for entry in entries),
            "views": len(entries),
            "boards": [described(board) for board in boards],
            "warnings": [one.code for one in report.warnings],
        }
        write_atomically(order.output, camera_file_text(file, facts).encode())
        written.append(order.output)
    if order.plots is not None:
        for name, svg in (("residuals.svg", residuals_svg(report)), ("coverage.svg", coverage_svg(report))):
            write_atomically(order.plots / name, svg.encode())
            written.append(order.plots / name)
    return tuple(written)


def _reject_writing_over(output: Path | None, files: Sequence[Path]) -> None:
    if output is not None and any(output.exists() and file.samefile(output) for file in files):
        raise InvalidInput(
            "OUTPUT_IS_INPUT",
            f"--output {output} would overwrite an image",
            "Give another file, such as camera.yaml.",
            {"file": str(output)},
        )
