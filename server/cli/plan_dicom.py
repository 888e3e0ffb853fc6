"""`coaxial plan dicom`: a plan as DICOM objects of the study of its CT."""

import hashlib
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import typer

from server.cli.options import SettingOptions, config_from_options
from server.cli.output import remark_text, write_atomically
from server.cli.plan_file import PlanFile, read_plan_file
from server.imaging import Ct
from server.imaging.ct_reader import read_ct
from server.imaging.dicom_objects import PlanObject, plan_objects, read_source
from server.imaging.labels.names import names_from_text
from server.imaging.labels.placement import labels_on_ct
from server.imaging.labels.reader import read_label_images
from server.imaging.meshes import read_mesh
from server.installation import product_version
from tracker.errors import InvalidInput
from tracker.plan import Surface, Volume
from tracker.plan.labels import LabelVolume

MAX_OFF_MM = 1e-6


@dataclass(frozen=True, slots=True, kw_only=True)
class DicomOptions:
    """Options of `coaxial plan dicom`."""

    plan: Path
    ct: Path
    output: Path | None = None
    labels: Path | None = None
    names: str = ""
    surfaces: tuple[str, ...] = ()
    series: str | None = None


def write_plan_dicom(options: DicomOptions) -> None:
    """Write the objects of an exported plan into a folder.

    Raises:
        InvalidInput: PLAN_FILE_INVALID, PLAN_OF_ANOTHER_CT, OUTPUT_NOT_WRITABLE, or a code beginning
            with CT_, LABEL, MESH, SURFACE or DICOM_.
        PlanError: the plan is invalid; LEVEL_DOUBTFUL.
    """
    folder = options.output or Path()
    for one in objects_of_plan(options):
        write_atomically(folder / one.file_name, one.content)
        typer.echo(f"Wrote {one.name} to {folder / one.file_name}")


def send_plan_dicom(options: DicomOptions, config: Path | None) -> None:
    """Send the objects of an exported plan to the archive of the settings, and print its answer for each.

    Raises:
        InvalidInput, PlanError: as `write_plan_dicom`; ARCHIVE_NOT_COMPLETE.
        ArchiveError: the archive cannot be reached.
    """
    from server.imaging.dicom_network.sender import send_objects  # noqa: PLC0415  only here

    settings = config_from_options(SettingOptions(config=config)).dicom
    answers = send_objects(objects_of_plan(options), settings)
    for one in answers:
        typer.echo(f"{one.name}: {one.text}")
    missing = sum(not one.is_stored for one in answers)
    if missing:
        raise InvalidInput(
            "ARCHIVE_NOT_COMPLETE",
            f"the archive did not store {missing} of {len(answers)} objects",
            "See its answer for each; sending again makes new objects.",
            {"missing": missing, "objects": len(answers)},
        )


def objects_of_plan(options: DicomOptions) -> tuple[PlanObject, ...]:
    """Return the objects of an exported plan; its CT must have the checksum that the plan states."""
    file = read_plan_file(options.plan)
    source = read_source(options.ct, series=options.series)
    with tempfile.TemporaryDirectory() as folder:
        voxels = Path(folder) / "voxels.npy"
        ct = read_ct(options.ct, series=options.series, into=voxels)
        _check_same_ct(file, ct, voxels)
        volume = ct.volume.in_patient_order()
        labels = None if options.labels is None else _labels(options.labels, options.names, volume)
        surfaces = _surfaces(options.surfaces, volume)
    return plan_objects(source, file.plan, version=product_version(), labels=labels, surfaces=surfaces)


def _check_same_ct(file: PlanFile, ct: Ct, voxels: Path) -> None:
    with voxels.open("rb") as content:
        checksum = hashlib.file_digest(content, "sha256").hexdigest()
    stated = file.ct_marks.get("lps_from_ijk")
    try:
        affine = np.array(stated, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        affine = np.zeros(0)
    own = ct.volume.lps_from_ijk
    is_same_placement = affine.shape == own.shape and np.allclose(affine, own, rtol=0.0, atol=MAX_OFF_MM)
    if file.ct_marks.get("voxels_sha256") != checksum or not is_same_placement:
        raise InvalidInput(
            "PLAN_OF_ANOTHER_CT",
            "the plan was made on another CT than the given one, or does not state its CT",
            "Give the CT series of the case in which the plan was made, with --series if there are several.",
        )


def _labels(path: Path, names: str, volume: Volume) -> LabelVolume:
    placed = labels_on_ct(read_label_images(path, names=names_from_text(names)), volume)
    for warning in placed.warnings:
        typer.echo(f"Note: {remark_text(warning)}", err=True)
    return placed.volume


def _surfaces(given: tuple[str, ...], volume: Volume) -> Mapping[str, Surface]:
    surfaces: dict[str, Surface] = {}
    for text in given:
        name, equals, path = text.partition("=")
        if not (equals and name.strip() and path) or name in surfaces:
            raise InvalidInput(
                "SURFACE_OPTION_INVALID",
                f"--surface is '{text}', expected the name of a vertebra and a file, each vertebra once",
                "Give it as --surface L3=bone.stl.",
                {"surface": text},
            )
        mesh = read_mesh(Path(path))
        if not mesh.closed:
            typer.echo(f"Note: the surface of {name} is not closed and is written as a model only.", err=True)
        surface = mesh.surface
        if not volume.contains(surface.vertices_mm).all():
            raise InvalidInput(
                "SURFACE_OUTSIDE_CT",
                f"the surface of {name} does not lie within the CT",
                "Give a surface in the coordinates of this CT.",
                {"vertebra": name},
            )
        surfaces[name] = surface
    return surfaces
