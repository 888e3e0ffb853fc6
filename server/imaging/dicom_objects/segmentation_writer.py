"""Writing of labels and filled surfaces as a DICOM Segmentation (PS3.3, A.51), on the slices of the CT."""

from collections.abc import Mapping

import highdicom as hd
import numpy as np
import numpy.typing as npt
from pydicom.dataset import Dataset
from pydicom.sr.codedict import codes

from server.imaging.dicom_objects.codes import CODE_OF_LEVEL
from server.imaging.dicom_objects.equipment import Equipment
from server.imaging.dicom_objects.filling import filled
from server.imaging.dicom_objects.source import SourceSeries
from tracker.errors import InvalidInput
from tracker.plan import Surface
from tracker.plan.labels import CLASS_OF_LEVEL, LabelVolume

# Many programs stack the frames of a segmentation at right angles whatever their positions are, and draw
# sheared ones beside the bone. The limit is the shift against a right-angled stack over the whole height.
MAX_SHEAR_MM = 0.1
MAX_OFF_GRID_VOXELS = 1e-3
# How the voxels of a segment came about; labels were made elsewhere.
OF_LABELS, OF_SURFACE = "labels of another program, resampled", "surface, filled"


def sheared_mm(source: SourceSeries) -> float:
    """Return how far the last slice is shifted against a right-angled stack."""
    return float(np.tan(np.radians(source.stack.tilt_deg)) * source.stack.spacing_mm * len(source.frames))


def segmentation_object(
    source: SourceSeries, labels: LabelVolume | None, surfaces: Mapping[str, Surface], equipment: Equipment
) -> Dataset | None:
    """Return a binary segmentation with one segment for each level; None without any voxel.

    Args:
        source: the CT.
        labels: in its voxels.
        surfaces: closed surfaces by level, for levels without label.
        equipment: of the export.

    Raises:
        InvalidInput: DICOM_SEG_TILTED, DICOM_LABELS_OFF_GRID.
    """
    _check_shear(source)
    shape = (len(source.frames), *source.size_wh_px[::-1])
    on_slices = np.zeros(shape, np.uint8) if labels is None else _on_slices(source, labels)
    origins = {} if labels is None else dict.fromkeys(labels.levels, OF_LABELS)
    for level, surface in surfaces.items():
        if level not in origins:
            inside = filled(source, surface) & (on_slices == 0)
            on_slices[inside] = CLASS_OF_LEVEL[level]
            if inside.any():
                origins[level] = OF_SURFACE
    levels = [level for level in CLASS_OF_LEVEL if level in origins]
    used = np.flatnonzero(on_slices.any(axis=(1, 2)))
    if not used.size:
        return None
    low, high = int(used[0]), int(used[-1]) + 1
    numbers = np.zeros(256, dtype=np.uint8)
    for n, level in enumerate(levels, start=1):
        numbers[CLASS_OF_LEVEL[level]] = n
    columns, rows = source.stack.lps_from_ijk[:3, 0], source.stack.lps_from_ijk[:3, 1]
    between_columns, between_rows = float(np.linalg.norm(columns)), float(np.linalg.norm(rows))
    images = sorted({source.frames[k].image for k in range(low, high)})
    return hd.seg.Segmentation(
        source_images=[equipment.without_patient(source.images[n]) for n in images],
        pixel_array=numbers[on_slices[low:high]],
        segmentation_type=hd.seg.SegmentationTypeValues.BINARY,
        segment_descriptions=[
            _description(n, level, origins[level], equipment) for n, level in enumerate(levels, start=1)
        ],
        pixel_measures=hd.PixelMeasuresSequence(
            pixel_spacing=(between_rows, between_columns),
            slice_thickness=source.thickness_mm,
            spacing_between_slices=source.stack.spacing_mm,
        ),
        plane_orientation=hd.PlaneOrientationSequence(
            coordinate_system="PATIENT",
            image_orientation=[*(columns / between_columns), *(rows / between_rows)],
        ),
        plane_positions=[
            hd.PlanePositionSequence(
                coordinate_system="PATIENT", image_position=source.position_lps_mm(k).tolist()
            )
            for k in range(low, high)
        ],
        content_label="VERTEBRAE",
        content_description="Vertebrae",
        **equipment.of_series("bone", number=9901),
    )


def _description(number: int, level: str, origin: str, equipment: Equipment) -> hd.seg.SegmentDescription:
    return hd.seg.SegmentDescription(
        segment_number=number,
        segment_label=level,
        segmented_property_category=codes.SCT.AnatomicalStructure,
        segmented_property_type=CODE_OF_LEVEL[level],
        algorithm_type=hd.seg.SegmentAlgorithmTypeValues.SEMIAUTOMATIC,
        algorithm_identification=hd.AlgorithmIdentificationSequence(
            name=origin,
            family=codes.DCM.ManualProcessing,
            version=equipment.version,
        ),
        tracking_id=level,
        tracking_uid=equipment.tracking_uid(level),
    )


def _check_shear(source: SourceSeries) -> None:
    by_mm = sheared_mm(source)
    if by_mm > MAX_SHEAR_MM:
        raise InvalidInput(
            "DICOM_SEG_TILTED",
            f"the slices are tilted by {source.stack.tilt_deg:.1f} deg and shifted by {by_mm:.1f} mm "
            f"against a right-angled stack, allowed {MAX_SHEAR_MM:g} mm: many programs would show the "
            "segmentation beside the bone",
            "Write models and report without labels, or use a CT without gantry tilt.",
            {"tilt_deg": source.stack.tilt_deg, "sheared_mm": by_mm, "max_mm": MAX_SHEAR_MM},
        )


def _on_slices(source: SourceSeries, labels: LabelVolume) -> npt.NDArray[np.uint8]:
    """Return the class numbers (slices, rows, columns) on the slices of the series.

    Labels are in the order of the patient's axes, so that their axes may be permuted against the slices.
    """
    index_from_label = np.linalg.inv(source.stack.lps_from_ijk) @ labels.lps_from_ijk
    rounded = np.rint(index_from_label).astype(int)
    axes = rounded[:3, :3]
    is_permutation = np.array_equal(axes @ axes.T, np.eye(3)) and axes.min() >= 0
    order = axes.argmax(axis=1)
    part = labels.labels.transpose([2 - order[2], 2 - order[1], 2 - order[0]])
    i, j, k = rounded[:3, 3]
    whole = np.zeros((len(source.frames), *source.size_wh_px[::-1]), dtype=np.uint8)
    is_inside = min(i, j, k) >= 0 and all(
        start + size <= full for start, size, full in zip((k, j, i), part.shape, whole.shape, strict=True)
    )
    off = float(np.abs(index_from_label - rounded).max())
    if not (is_permutation and is_inside and off < MAX_OFF_GRID_VOXELS):
        raise InvalidInput(
            "DICOM_LABELS_OFF_GRID",
            "the labels do not lie on the voxels of this CT",
            "Give the labels and the CT of the same case.",
        )
    whole[k : k + part.shape[0], j : j + part.shape[1], i : i + part.shape[2]] = part
    return whole
