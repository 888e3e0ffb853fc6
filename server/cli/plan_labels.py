"""`coaxial plan labels`: check a segmentation of the vertebrae against its CT."""

import json
from dataclasses import dataclass
from pathlib import Path

import typer

from server.cli.output import remark_text, write_atomically
from server.imaging.ct_reader import read_ct
from server.imaging.labels.label_file import label_file_bytes
from server.imaging.labels.names import names_from_text
from server.imaging.labels.placement import labels_on_ct
from server.imaging.labels.reader import read_label_images
from server.planning.labels import labels_content


@dataclass(frozen=True, slots=True, kw_only=True)
class LabelOptions:
    """Options of `coaxial plan labels`."""

    ct: Path
    segmentation: Path
    names: str = ""
    series: str | None = None
    output: Path | None = None


def check_labels(options: LabelOptions, *, as_json: bool) -> None:
    """Check the labels, print what was found, and write them in the voxels of the CT if requested.

    Raises:
        InvalidInput: a code beginning with CT_ or LABEL.
        PlanError: LEVEL_DOUBTFUL.
    """
    names = names_from_text(options.names)
    ct = read_ct(options.ct, series=options.series)
    volume = ct.volume.in_patient_order()
    placed = labels_on_ct(read_label_images(options.segmentation, names=names), volume)
    if options.output is not None:
        write_atomically(options.output, label_file_bytes(placed.volume))
    content = labels_content(placed)
    if as_json:
        typer.echo(json.dumps(content))
        return
    for one in placed.vertebrae:
        x, y, z = one.centroid_lps_mm
        cut = ", cut by the border of the CT" if one.is_cut else ""
        typer.echo(f"{one.level:<4}{one.volume_ml:6.1f} ml at ({x:.1f}, {y:.1f}, {z:.1f}) mm LPS{cut}")
    typer.echo(f"Contrast to the surroundings: {placed.contrast_hu:.0f} HU")
    for warning in placed.warnings:
        typer.echo(f"Note: {remark_text(warning)}")
