"""`coaxial accuracy` and `coaxial ruler`: compare known and measured displacements, as in Table 2."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import typer

from server.calibration import ROW_COLUMNS, accuracy_rows, accuracy_values
from server.camera_file import load_camera_file
from server.cli.board_names import BoardOptions
from server.cli.board_options import boards_of
from server.cli.point_rows import read_columns
from server.image_file import decoded
from tracker.camera.accuracy import (
    AccuracyReport,
    accuracy_left_out,
    accuracy_of_grid,
    accuracy_of_ruler,
    accuracy_on_plane,
)
from tracker.camera.detection import BoardNotFound, board_as_seen, find_board
from tracker.camera.displacements import Displacements
from tracker.camera.ruler import Ruler, angle_deg, axial_distance_mm, distances, pixels_per_mm
from tracker.errors import InvalidInput

PLANE_COLUMNS = ("x_mm", "y_mm", "u_px", "v_px")
HEADINGS = (
    *("X1 mm", "Y1 mm", "X2 mm", "Y2 mm", "Rd mm", "X1 px", "Y1 px", "X2 px", "Y2 px"),
    *("Pd px", "Pd/Rd", "measured", "error mm"),
)
FAILED = 1


def check_rows(rows: Path | None, *, camera: Path, plane: Path | None, limit_mm: float, as_json: bool) -> int:
    """Print the errors of a calibrated camera. Return the exit status: 0, or 1 above the limit.

    Raises:
        NavigationError: a file cannot be used, or the pose of the plane is undetermined.
    """
    if rows is None:
        raise InvalidInput(
            "ACCURACY_WITHOUT_POINTS",
            "neither displacements nor an image of a board are given",
            "Give a CSV of displacements, or an image of a board with --image, --pattern and --size.",
        )
    model = load_camera_file(camera)
    displacements = _displacements(rows)
    if plane is None:
        report = accuracy_left_out(model, displacements)
        how = "each displacement was excluded from the fit that measures it"
    else:
        points = read_columns(plane, PLANE_COLUMNS)
        report = accuracy_on_plane(model, displacements, fit_mm=points[:, :2], fit_px=points[:, 2:])
        how = f"the plane was fitted to the {report.fit_points} points of {plane}"
    return _print_report(
        report, limit_mm, how, held_out_by="rows" if plane is None else "plane", as_json=as_json
    )


def check_on_board(image: Path, given: BoardOptions, *, camera: Path, limit_mm: float, as_json: bool) -> int:
    """Check the camera on a calibration board in an image; see `check_rows`.

    Raises:
        NavigationError: a file cannot be used, or the board is not found.
    """
    board = boards_of(given)[0]
    model = load_camera_file(camera)
    picture = _picture(image, model.size_wh_px)
    seen = find_board(picture, board_as_seen([picture], board))
    if isinstance(seen, BoardNotFound):
        raise InvalidInput(
            "BOARD_NOT_SEEN",
            f"the board is not found in {image}: {seen.sentence}",
            "Check --size, and use an image that shows the whole board in focus.",
            {"file": str(image), "reason": seen.reason.value, "seen_points": seen.seen_points},
        )
    report = accuracy_of_grid(model, seen.object_points_mm[:, :2], seen.image_points_px)
    how = f"fitted to {report.fit_points} of {seen.ids.size} points, the others were measured"
    return _print_report(report, limit_mm, how, held_out_by="every other point", as_json=as_json)


def _picture(path: Path, size_wh_px: tuple[int, int]) -> npt.NDArray[np.uint8]:
    try:
        picture = decoded(path.read_bytes(), grey=True)
    except OSError:
        picture = None
    if picture is None:
        raise InvalidInput(
            "IMAGE_UNREADABLE",
            f"{path} is not a readable image",
            "Give a PNG, JPEG or BMP file.",
            {"file": str(path)},
        )
    height, width = picture.shape
    if (width, height) != size_wh_px:
        raise InvalidInput(
            "IMAGE_SIZE_DIFFERS",
            f"{path} is {width}x{height} px, the camera was calibrated at {size_wh_px[0]}x{size_wh_px[1]}",
            "Use images of the calibrated size.",
            {"size_wh_px": [width, height], "camera_size_wh_px": list(size_wh_px)},
        )
    return picture


def _print_report(
    report: AccuracyReport, limit_mm: float, how: str, *, held_out_by: str, as_json: bool
) -> int:
    if as_json:
        typer.echo(json.dumps(accuracy_values(report, limit_mm=limit_mm) | {"held_out_by": held_out_by}))
    else:
        typer.echo(_table(report))
        typer.echo(
            f"Distance of the plane: {report.plane_distance_mm:.1f} mm; compare it with a tape measure. "
            f"Its fit has {report.fit_rms_px:.2f} px RMS; {how}."
        )
        typer.echo(_verdict(report, limit_mm))
    return 0 if report.maximum_error_mm <= limit_mm else FAILED


def measure_with_ruler(
    rows: Path | None,
    *,
    vertical_mm: float,
    horizontal_mm: float,
    focal_length_px: float | None,
    limit_mm: float,
    as_json: bool,
) -> int:
    """Print the result of the ruler method of the paper. Return the exit status: 0, or 1 above the limit.

    Raises:
        NavigationError: V, H or f is invalid, or the file cannot be used.
    """
    geometry: dict[str, Any] = {
        "axial_distance_mm": axial_distance_mm(vertical_mm, horizontal_mm),
        "angle_deg": angle_deg(vertical_mm, horizontal_mm),
    }
    sentence = f"D = {geometry['axial_distance_mm']:.1f} mm, theta = {geometry['angle_deg']:.1f} deg"
    displacements = None if rows is None else _displacements(rows)
    if focal_length_px is None and displacements is not None:
        displacements, ruler = _from_first(displacements, vertical_mm, horizontal_mm)
        sentence += f", f = {ruler.focal_length_px:.1f} px from the first row, which is not checked itself"
    elif focal_length_px is not None:
        ruler = Ruler(vertical_mm=vertical_mm, horizontal_mm=horizontal_mm, focal_length_px=focal_length_px)
        sentence += f", f = {focal_length_px:.1f} px, Pd/Rd = {ruler.pixels_per_mm:.3f} px/mm"
    else:
        typer.echo(json.dumps(geometry) if as_json else f"{sentence}.")
        return 0
    geometry |= {"focal_length_px": ruler.focal_length_px, "pixels_per_mm": ruler.pixels_per_mm}
    if displacements is None:
        typer.echo(json.dumps(geometry) if as_json else f"{sentence}.")
        return 0
    report = accuracy_of_ruler(ruler, displacements)
    if as_json:
        typer.echo(json.dumps(geometry | accuracy_values(report, limit_mm=limit_mm)))
    else:
        typer.echo(f"{_table(report)}\n{sentence}.\n{_verdict(report, limit_mm)}")
    return 0 if report.maximum_error_mm <= limit_mm else FAILED


def _from_first(
    displacements: Displacements, vertical_mm: float, horizontal_mm: float
) -> tuple[Displacements, Ruler]:
    """Return the ruler that follows from the first row, and the remaining rows to check it."""
    known = distances(displacements.first_mm, displacements.second_mm)
    seen = distances(displacements.first_px, displacements.second_px)
    if known.size < 2:
        raise InvalidInput(
            "RULER_UNCHECKED",
            "the only row determines the focal length, so that none is left for a check",
            "Give at least two rows, or the focal length with --focal-length-px.",
            {"rows": int(known.size)},
        )
    ratio = pixels_per_mm(float(seen[0]), float(known[0]))
    ruler = Ruler.from_displacement(vertical_mm=vertical_mm, horizontal_mm=horizontal_mm, pixels_per_mm=ratio)
    rest = Displacements(
        first_mm=displacements.first_mm[1:],
        second_mm=displacements.second_mm[1:],
        first_px=displacements.first_px[1:],
        second_px=displacements.second_px[1:],
    )
    return rest, ruler


def _displacements(path: Path) -> Displacements:
    values = read_columns(path, ROW_COLUMNS)
    return Displacements(
        first_mm=values[:, 0:2], second_mm=values[:, 2:4], first_px=values[:, 4:6], second_px=values[:, 6:8]
    )


def _table(report: AccuracyReport) -> str:
    digits = (1, 1, 1, 1, 2, 1, 1, 1, 1, 1, 3, 2, 2)
    lines = ["  ".join(f"{heading:>8}" for heading in HEADINGS)]
    lines += [
        "  ".join(f"{value:8.{places}f}" for value, places in zip(row, digits, strict=True))
        for row in accuracy_rows(report)
    ]
    return "\n".join(lines)


def _verdict(report: AccuracyReport, limit_mm: float) -> str:
    words = "passes" if report.maximum_error_mm <= limit_mm else "does not pass"
    return (
        f"Largest error {report.maximum_error_mm:.2f} mm, RMS {report.rms_error_mm:.2f} mm over "
        f"{report.errors_mm.size} displacements: {words} the limit of {limit_mm:g} mm."
    )
