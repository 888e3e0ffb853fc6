"""Writing of markups for 3D Slicer."""

from collections.abc import Sequence
from pathlib import Path

from server.cli.output import write_atomically
from server.slicer_file import Markup, is_markups_name, markups_to_bytes
from tracker.errors import InvalidInput


def write_markups(path: Path, markups: Sequence[Markup]) -> None:
    """Write a file of markups.

    Raises:
        InvalidInput: MARKUPS_NAME_INVALID, OUTPUT_NOT_WRITABLE.
    """
    if not is_markups_name(path.name):
        raise InvalidInput(
            "MARKUPS_NAME_INVALID",
            f"{path} does not end in .mrk.json, the suffix that 3D Slicer requires for markups",
            f"Give a name such as {path.with_suffix('.mrk.json').name}.",
            {"file": str(path)},
        )
    write_atomically(path, markups_to_bytes(markups))
