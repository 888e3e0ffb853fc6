"""Poses in text: rows of numbers, or named columns."""

import re
from math import isnan

import numpy as np

from server.pose_file.record import TIME_NAMES, PoseRecord, at_place, unreadable
from server.pose_file.structured import PoseFileContent
from server.pose_file.unit import Unit
from tracker.errors import InvalidInput
from tracker.pose.tool import rigid_from_matrix, rigid_from_quaternion

NO_NUMBERS = re.compile(r"[\[\](){},;|]")
COMMENT = re.compile(r"(#|%|//).*$")
LAST_ROW = [0.0, 0.0, 0.0, 1.0]
TIMES = {*TIME_NAMES, "frame", "index", "image_number"}
NAMES = {
    "x": ("x", "tx", "px", "pos_x", "x_mm", "tx_mm"),
    "y": ("y", "ty", "py", "pos_y", "y_mm", "ty_mm"),
    "z": ("z", "tz", "pz", "pos_z", "z_mm", "tz_mm"),
    "qw": ("qw", "q_w", "q0", "qr", "rot_w"),
    "qx": ("qx", "q_x", "q1", "qi", "rot_x"),
    "qy": ("qy", "q_y", "q2", "qj", "rot_y"),
    "qz": ("qz", "q_z", "q3", "qk", "rot_z"),
}
# x y z and a quaternion: the shortest row with a complete pose.
QUATERNION_ROW = 7
Row = tuple[int, list[float]]


def poses_from_text(text: str, *, name: str, unit: Unit) -> PoseFileContent:
    """Parse all poses in a text; a row of NaN only is an image without the marker.

    Raises:
        InvalidInput: POSES_UNREADABLE or POSE_MATRIX_INVALID, with the file and its line.
    """
    lines = [
        (number, COMMENT.sub("", line).strip()) for number, line in enumerate(text.splitlines(), start=1)
    ]
    lines = [(number, line) for number, line in lines if NO_NUMBERS.sub("", line).strip()]
    if not lines:
        raise unreadable(name, "it is empty")
    header: list[str] = []
    if _numbers(lines[0][1]) is None:
        header = [word.strip().strip('"').lower() for word in _split(lines[0][1])]
        lines = lines[1:]
    rows: list[Row] = []
    unseen = 0
    for number, line in lines:
        numbers = _numbers(line)
        if numbers is None:
            raise unreadable(f"{name}, line {number}", f"'{line[:40]}' is not a row of numbers")
        if _is_unseen(numbers):
            unseen += 1
        else:
            rows.append((number, numbers))
    widths = {len(numbers) for _, numbers in rows}
    if len(widths) > 1 and "[" in text:
        # A printed NumPy array wraps its rows.
        flat = [number for _, numbers in rows for number in numbers]
        if len(flat) % 16 == 0:
            blocks = [flat[at : at + 16] for at in range(0, len(flat), 16)]
            rows, widths = list(enumerate(blocks, start=1)), {16}
    if len(widths) != 1:
        shown = ", ".join(str(width) for width in sorted(widths))
        raise unreadable(name, f"its rows have different lengths ({shown or 'no rows'})")
    return PoseFileContent(poses=_from_rows(rows, header, name=name, unit=unit), unseen=unseen)


def contains_numbers(text: str) -> bool:
    """Return whether any line has at least three numbers; a text without such a line is a note."""
    return any(len(_numbers(line) or []) >= 3 for line in text.splitlines())


def _from_rows(rows: list[Row], header: list[str], *, name: str, unit: Unit) -> list[PoseRecord]:
    width = len(rows[0][1])
    if header and len(header) == width and not {"qw", "q_w", "q0", "qr", "rot_w"}.isdisjoint(header):
        return _from_quaternions(rows, header, name=name, unit=unit)
    times_s: list[float | None] = [None] * len(rows)
    if header and len(header) == width and header[0] in TIMES:
        if header[0] in TIME_NAMES:
            times_s = [numbers[0] for _, numbers in rows]
        rows = [(number, numbers[1:]) for number, numbers in rows]
        width -= 1
    if width == 4:
        return _from_blocks(rows, name=name, unit=unit)
    if width in {13, 17}:
        # A time precedes the matrix.
        times_s = [numbers[0] for _, numbers in rows]
        rows = [(number, numbers[1:]) for number, numbers in rows]
        width -= 1
    if width not in {12, 16}:
        hint = "; a header must state the order of the quaternion components" if width in {7, 8} else ""
        raise unreadable(name, f"its rows have {width} numbers, expected 4, 12 or 16{hint}")
    return [
        _pose(np.array(numbers).reshape(-1, 4), f"{name}, line {number}", unit, time_s=time_s)
        for (number, numbers), time_s in zip(rows, times_s, strict=True)
    ]


def _from_blocks(rows: list[Row], *, name: str, unit: Unit) -> list[PoseRecord]:
    """Convert rows of four numbers: blocks of four rows, or of three without the last row."""
    count = len(rows)
    with_last = count % 4 == 0 and (count % 3 != 0 or any(numbers == LAST_ROW for _, numbers in rows))
    size = 4 if with_last else 3
    if count % size != 0:
        raise unreadable(name, f"it has {count} rows of 4 numbers, which is not a multiple of a 4x4 matrix")
    single = count == size
    found = []
    for start in range(0, count, size):
        place = name if single else f"{name}, line {rows[start][0]}"
        found.append(_pose(np.array([numbers for _, numbers in rows[start : start + size]]), place, unit))
    return found


def _from_quaternions(rows: list[Row], header: list[str], *, name: str, unit: Unit) -> list[PoseRecord]:
    column_of = {}
    for part, names in NAMES.items():
        there = [header.index(one) for one in names if one in header]
        if not there:
            raise unreadable(name, f"its header ({', '.join(header)}) has no column for {part}")
        column_of[part] = there[0]
    time_column = next((header.index(one) for one in TIME_NAMES if one in header), None)
    found = []
    for number, numbers in rows:
        place = f"{name}, line {number}"
        quaternion = [numbers[column_of[part]] for part in ("qw", "qx", "qy", "qz")]
        translation = [numbers[column_of[part]] for part in ("x", "y", "z")]
        try:
            pose = rigid_from_quaternion(quaternion, translation, unit_mm=unit.in_mm)
        except InvalidInput as error:
            raise at_place(place, error) from None
        time_s = None if time_column is None else numbers[time_column]
        found.append(PoseRecord(place=place, pose=pose, time_s=time_s))
    return found


def _pose(matrix: np.ndarray, place: str, unit: Unit, *, time_s: float | None = None) -> PoseRecord:
    try:
        return PoseRecord(place=place, pose=rigid_from_matrix(matrix, unit_mm=unit.in_mm), time_s=time_s)
    except InvalidInput as error:
        raise at_place(place, error) from None


def _split(line: str) -> list[str]:
    parts = line.split(",") if "," in line else line.split(";") if ";" in line else line.split()
    return [part.strip() for part in parts if part.strip()]


def _is_unseen(numbers: list[float]) -> bool:
    """Return whether the marker was not detected: only NaN after the time."""
    return all(isnan(number) for number in numbers[-QUATERNION_ROW:])


def _numbers(line: str) -> list[float] | None:
    if ";" in line and "." not in line:
        line = line.replace(",", ".")
    try:
        return [float(word) for word in NO_NUMBERS.sub(" ", COMMENT.sub("", line)).split()]
    except ValueError:
        return None
