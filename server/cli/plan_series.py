"""`coaxial plan series`: list the series of a CT folder, zip or file, without the patient name."""

import dataclasses
import json
from pathlib import Path

import typer

from server.imaging import SeriesDescription
from server.imaging.ct_reader import list_series


def print_series(ct: Path, *, as_json: bool) -> None:
    """Print the series, one per line or as JSON.

    Raises:
        InvalidInput: a code beginning with CT_.
    """
    found = list_series(ct)
    if as_json:
        typer.echo(json.dumps({"series": [dataclasses.asdict(one) for one in found]}))
    else:
        typer.echo("\n".join(_line(one) for one in found))


def _line(one: SeriesDescription) -> str:
    columns, rows = one.size_wh_px
    across, down = one.pixel_mm
    parts = [
        one.series,
        one.modality,
        f"{one.images} slices",
        f"{columns} x {rows}",
        f"{across:g} x {down:g} mm",
        f"{one.thickness_mm:g} mm thick" if one.thickness_mm > 0.0 else "",
        one.words,
        f"not usable for planning: {one.problem}" if one.problem else "",
    ]
    return ", ".join(part for part in parts if part)
