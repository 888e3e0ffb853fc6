"""Messages about the CT."""

from collections.abc import Mapping
from typing import Annotated, TypeAlias

from pydantic import Field

from server.api.case_messages import HeadingMessage
from server.api.jobs import JobMessage, job_message
from server.api.remark_messages import RemarkMessage, stored_remark_messages
from server.procedure.ct import CtUpload
from server.stream.messages import Message
from tracker.plan import Volume
from tracker.plan.slices import WINDOWS, Plane, Slice, reach_mm
from tracker.plan.slices.planes import VIEWS

# No patient is farther from the scanner's origin.
Coordinate: TypeAlias = Annotated[float, Field(ge=-10_000.0, le=10_000.0, allow_inf_nan=False)]
PointLps: TypeAlias = Annotated[list[Coordinate], Field(min_length=3, max_length=3)]


class UploadMessage(JobMessage):
    """A CT that is being read.

    If it contains several series, the result of the job lists them under `series`.
    """

    upload_id: str


class ReachMessage(Message):
    """Range of a slice plane in LPS: z for axial, x for sagittal, y for coronal."""

    from_mm: float
    to_mm: float
    step_mm: float
    """Distance between slices."""


class WindowMessage(Message):
    """Display window in Hounsfield units: width around the level."""

    window_hu: float
    level_hu: float


def preset_messages() -> dict[str, WindowMessage]:
    """Return the display windows by name."""
    return {
        name: WindowMessage(window_hu=one.width_hu, level_hu=one.centre_hu) for name, one in WINDOWS.items()
    }


class CtMessage(Message):
    """The CT of the open case."""

    heading: HeadingMessage
    size_ijk: list[int]
    """Voxels along left-right, front-back, feet-head."""
    spacing_mm: list[float]
    lps_from_ijk: list[list[float]]
    """4x4 matrix."""
    planes: dict[Plane, ReachMessage]
    presets: dict[str, WindowMessage]
    description: dict[str, object]
    """Series description from the DICOM header."""
    warnings: list[RemarkMessage]
    """Warnings for planning."""
    left_out: list[dict[str, object]]


class EdgesMessage(Message):
    """Anatomical direction of each image edge: L/R, A/P, H/F."""

    left: str
    right: str
    top: str
    bottom: str


class SliceMessage(Message):
    """Geometry of the pixels of a slice."""

    width_px: int
    height_px: int
    pixel_mm: list[float]
    """Column and row spacing."""
    lps_from_px: list[list[float]]
    """3x3 matrix from (u, v, 1) to LPS in mm; the centre of the top-left pixel is (0, 0)."""
    normal_lps: list[float]
    """Viewing direction."""
    edges: EdgesMessage
    at_mm: float | None
    """Position of an axial, sagittal or coronal slice; null for oblique slices."""


class ProbeRequest(Message):
    """A point in the patient."""

    point_lps_mm: PointLps


class ProbeMessage(Message):
    """CT value at a point."""

    hu: float
    """Linear interpolation; -1024 outside the CT."""
    inside: bool
    index_ijk: list[float]
    """Voxel index in the order of `size_ijk`."""


def upload_message(begun: CtUpload) -> UploadMessage:
    """Return the message of an upload."""
    return UploadMessage(upload_id=begun.upload_id, **job_message(begun.job).model_dump())


def ct_message(heading: HeadingMessage, content: Mapping[str, object], volume: Volume) -> CtMessage:
    """Return the message of the CT."""
    return CtMessage(
        heading=heading,
        size_ijk=list(volume.shape_ijk),
        spacing_mm=volume.spacing_mm.tolist(),
        lps_from_ijk=volume.lps_from_ijk.tolist(),
        planes={plane: reach_message(volume, plane) for plane in VIEWS},
        presets=preset_messages(),
        description=mapping_of(content.get("description")),
        warnings=stored_remark_messages(content.get("warnings")),
        left_out=[mapping_of(one) for one in list_of(content.get("left_out"))],
    )


def reach_message(volume: Volume, plane: Plane) -> ReachMessage:
    """Return the message of the range of a plane."""
    low, high, step = reach_mm(volume, plane)
    return ReachMessage(from_mm=low, to_mm=high, step_mm=step)


def slice_message(one: Slice, *, at_mm: float | None = None) -> SliceMessage:
    """Return the message of the geometry of a slice."""
    width, height = one.size_wh_px
    edges = one.edges
    return SliceMessage(
        width_px=width,
        height_px=height,
        pixel_mm=one.pixel_mm.tolist(),
        lps_from_px=one.lps_from_px.tolist(),
        normal_lps=one.normal_lps.tolist(),
        edges=EdgesMessage(left=edges.left, right=edges.right, top=edges.top, bottom=edges.bottom),
        at_mm=at_mm,
    )


def mapping_of(value: object) -> dict[str, object]:
    """Return the value as a mapping; empty if it is not one."""
    return {str(key): one for key, one in value.items()} if isinstance(value, Mapping) else {}


def list_of(value: object) -> list[object]:
    """Return the value as a list; empty if it is not one."""
    return list(value) if isinstance(value, (list, tuple)) else []
