"""All DICOM objects of a plan, as the bytes of their files."""

import io
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import pydicom
from pydicom.dataset import Dataset

from server.imaging.dicom.header import BAD_DICOM, without_warnings
from server.imaging.dicom_objects.codes import ascii_text, code_of_vertebra
from server.imaging.dicom_objects.equipment import Equipment
from server.imaging.dicom_objects.filling import is_closed
from server.imaging.dicom_objects.model import cylinder, model_object
from server.imaging.dicom_objects.report import has_measurements, report_object
from server.imaging.dicom_objects.segmentation_writer import MAX_SHEAR_MM, segmentation_object, sheared_mm
from server.imaging.dicom_objects.source import EXPORT_AGAIN, SourceSeries
from tracker.errors import InvalidInput
from tracker.plan import PlanDocument, Surface
from tracker.plan.labels import LabelVolume, level_from_name


@dataclass(frozen=True, slots=True, kw_only=True)
class PlanObject:
    """One DICOM file.

    Attributes:
        name: what it shows ("L3 left screw"); without anything that identifies the patient.
        file_name: for a folder of such files.
        sop_class_uid: kind of the object.
        content: the file, with patient and study.
    """

    name: str
    file_name: str
    sop_class_uid: str
    content: bytes


def plan_objects(
    source: SourceSeries,
    plan: PlanDocument,
    *,
    version: str,
    labels: LabelVolume | None = None,
    surfaces: Mapping[str, Surface] | None = None,
) -> tuple[PlanObject, ...]:
    """Return the objects of a plan: a segmentation if there are labels, models, and a report.

    Args:
        source: the CT on which the plan was made.
        plan: the plan.
        version: of this program.
        labels: of vertebrae, in the voxels of this CT.
        surfaces: bone surfaces in LPS mm by the name of their vertebra; closed ones are also segmented,
            unless the labels have their level or the slices are tilted.

    Raises:
        InvalidInput: DICOM_NOTHING_TO_WRITE, DICOM_SEG_TILTED, DICOM_LABELS_OFF_GRID, or
            DICOM_SOURCE_INCOMPLETE.
    """
    equipment = Equipment(version=version, source_series_uid=source.series_uid)
    found: list[tuple[str, Dataset]] = []
    closed = _closed(surfaces or {})
    if labels is not None or (closed and sheared_mm(source) <= MAX_SHEAR_MM):
        segmentation = segmentation_object(source, labels, closed, equipment)
        found += [] if segmentation is None else [("bone", segmentation)]
    found += _models(source, plan, surfaces or {}, equipment)
    if has_measurements(plan):
        found.append(("report", report_object(source, plan, equipment)))
    if not found:
        raise InvalidInput(
            "DICOM_NOTHING_TO_WRITE",
            f"the plan has {len(plan.vertebrae)} vertebrae, but no pedicle and no channel, and there are "
            "no labels and surfaces",
            "Measure a pedicle, place a channel, or give labels.",
            {"vertebrae": len(plan.vertebrae)},
        )
    return tuple(_finished(source, name, dataset) for name, dataset in found)


def _closed(surfaces: Mapping[str, Surface]) -> dict[str, Surface]:
    """Return the surfaces by level that have an inside."""
    levels = {level_from_name(name): surface for name, surface in surfaces.items()}
    return {level: one for level, one in levels.items() if level is not None and is_closed(one)}


def _models(
    source: SourceSeries, plan: PlanDocument, surfaces: Mapping[str, Surface], equipment: Equipment
) -> Iterator[tuple[str, Dataset]]:
    """Yield the models, in one series."""
    series = equipment.of_series("models", number=9902)
    parts: list[tuple[str, str, Surface]] = [
        (name, f"{ascii_text(name)} bone", surface) for name, surface in surfaces.items()
    ]
    for vertebra in plan.vertebrae:
        for planned in vertebra.channels:
            entry_mm = planned.channel.entry_in_vertebra_mm
            name = f"{ascii_text(vertebra.name)} {planned.side}"
            channel = cylinder(entry_mm, planned.channel.target_in_vertebra_mm, planned.channel.radius_mm)
            parts.append((vertebra.name, f"{name} channel", channel))
            for screw in planned.screws:
                tip_mm = entry_mm + screw.length_mm * planned.channel.axis_in_vertebra
                shaft = cylinder(entry_mm, tip_mm, 0.5 * screw.diameter_mm)
                parts.append((vertebra.name, f"{name} screw", shaft))
    for number, (vertebra_name, title, surface) in enumerate(parts, start=1):
        identifiers = {**series, "instance_number": number, "sop_instance_uid": pydicom.uid.generate_uid()}
        kind = code_of_vertebra(vertebra_name)
        yield title, model_object(source, surface, title=title, kind=kind, series=identifiers)


def _finished(source: SourceSeries, name: str, dataset: Dataset) -> PlanObject:
    """Add patient and study, and write the file."""
    source.add_identity(dataset)
    content = io.BytesIO()
    try:
        with without_warnings():
            pydicom.dcmwrite(content, dataset, enforce_file_format=True)
    except BAD_DICOM:
        # The exception may quote the patient's name.
        raise InvalidInput(
            "DICOM_SOURCE_INCOMPLETE",
            "patient or study in the headers of the CT cannot be written",
            EXPORT_AGAIN,
            {"attribute": "?"},
        ) from None
    letters = "".join(letter if letter.isalnum() else "-" for letter in name.lower())
    return PlanObject(
        name=name,
        file_name=f"{letters}.dcm",
        sop_class_uid=str(dataset.SOPClassUID),
        content=content.getvalue(),
    )
