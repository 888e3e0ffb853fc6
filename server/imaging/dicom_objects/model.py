"""Channels, screws and bone surfaces as Encapsulated STL (DICOM PS3.3, A.85), in patient coordinates."""

from typing import Any

import highdicom as hd
import numpy as np
from pydicom.dataset import Dataset
from pydicom.sr.codedict import codes
from pydicom.sr.coding import Code
from pydicom.uid import EncapsulatedSTLStorage, ExplicitVRLittleEndian

from server.imaging.dicom_objects.source import SourceSeries
from server.imaging.meshes import stl_from_surface
from tracker.geometry import Array
from tracker.plan import Surface

# Corners of a circle: the sides of a screw of 8 mm lie at most 0.005 mm inside of it.
CORNERS = 96


def cylinder(start_mm: Array, end_mm: Array, radius_mm: float) -> Surface:
    """Return a closed cylinder between two points (3,); its corners lie on the circle."""
    axis = (end_mm - start_mm) / np.linalg.norm(end_mm - start_mm)
    across = np.cross(axis, np.eye(3)[np.abs(axis).argmin()])
    across /= np.linalg.norm(across)
    angle = 2.0 * np.pi * np.arange(CORNERS)[:, None] / CORNERS
    ring = radius_mm * (np.cos(angle) * across + np.sin(angle) * np.cross(axis, across))
    here = np.arange(CORNERS)
    following, first, last = (
        (here + 1) % CORNERS,
        np.full(CORNERS, 2 * CORNERS),
        np.full(CORNERS, 2 * CORNERS + 1),
    )
    return Surface(
        vertices_mm=np.concatenate([start_mm + ring, end_mm + ring, [start_mm], [end_mm]]),
        faces=np.concatenate(
            [
                np.stack([here, following, following + CORNERS], axis=1),
                np.stack([here, following + CORNERS, here + CORNERS], axis=1),
                np.stack([first, following, here], axis=1),
                np.stack([last, here + CORNERS, following + CORNERS], axis=1),
            ]
        ),
    )


def model_object(
    source: SourceSeries, surface: Surface, *, title: str, kind: Code, series: dict[str, Any]
) -> Dataset:
    """Return one surface as Encapsulated STL.

    Args:
        source: the CT.
        surface: in LPS mm.
        title: title of the document.
        kind: what the surface shows.
        series: arguments of `Equipment.of_series`.
    """
    one = hd.SOPClass(
        study_instance_uid=str(source.images[0].StudyInstanceUID),
        sop_class_uid=EncapsulatedSTLStorage,
        modality="M3D",
        transfer_syntax_uid=ExplicitVRLittleEndian,
        **series,
    )
    content = stl_from_surface(surface)
    one.FrameOfReferenceUID, one.PositionReferenceIndicator = source.frame_of_reference_uid, None
    one.AcquisitionDateTime, one.BurnedInAnnotation = None, "NO"
    one.DocumentTitle, one.ContentDescription = title, title
    one.ConceptNameCodeSequence = [hd.sr.CodedConcept.from_code(codes.cid7061.CT3DCAMModel)]
    one.MIMETypeOfEncapsulatedDocument = "model/stl"
    one.EncapsulatedDocument = content + bytes(len(content) % 2)
    one.EncapsulatedDocumentLength = len(content)
    one.MeasurementUnitsCodeSequence = [hd.sr.CodedConcept.from_code(codes.cid7063.Millimeter)]
    one.ModelUsageCodeSequence = [hd.sr.CodedConcept.from_code(codes.cid7064.PlanningIntent)]
    one.AnatomicRegionSequence = [hd.sr.CodedConcept.from_code(kind)]
    one.SourceInstanceSequence = [_reference(image) for image in source.images]
    referenced = Dataset()
    referenced.SeriesInstanceUID = source.series_uid
    referenced.ReferencedInstanceSequence = [_reference(image) for image in source.images]
    one.ReferencedSeriesSequence = [referenced]
    return one


def _reference(image: Dataset) -> Dataset:
    item = Dataset()
    item.ReferencedSOPClassUID, item.ReferencedSOPInstanceUID = image.SOPClassUID, image.SOPInstanceUID
    return item
