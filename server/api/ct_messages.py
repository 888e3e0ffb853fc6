"""What is asked and answered about the CT."""

from collections.abc import Mapping
from typing import Annotated, TypeAlias

from pydantic import Field

from server.api.case_messages import HeadingMessage
from server.api.jobs import JobMessage, job_message
from server.procedure.ct import ReadingBegun
from server.stream.messages import Message
from tracker.plan import Volume
from tracker.plan.slices import WINDOWS, Plane, Slice, reach_mm
from tracker.plan.slices.planes import VIEWS

# No patient is farther from the scanner's origin.
Coordinate: TypeAlias = Annotated[float, Field(ge=-10_000.0, le=10_000.0, allow_inf_nan=False)]
PointLps: TypeAlias = Annotated[list[Coordinate], Field(min_length=3, max_length=3)]


class UploadMessage(JobMessage):
    """A CT that is being read.

    Where it holds several series, the job's result lists them under `series`, and one is to be chosen.
    """

    upload_id: str


class ReachMessage(Message):
    """Where a plane can be moved: z for axial, x for sagittal, y for coronal, in LPS."""

    from_mm: float
    to_mm: float
    step_mm: float
    """From one slice to the next."""


class WindowMessage(Message):
    """Which Hounsfield units are shown: black to white around the level."""

    window_hu: float
    level_hu: float


class CtMessage(Message):
    """The CT of the open case."""

    heading: HeadingMessage
    size_ijk: list[int]
    """Voxels along left-right, front-back, feet-head."""
    spacing_mm: list[float]
    lps_from_ijk: list[list[float]]
    """4 rows of 4."""
    planes: dict[Plane, ReachMessage]
    presets: dict[str, WindowMessage]
    description: dict[str, object]
    """What the scanner says of the series."""
    warnings: list[str]
    """What to know before planning on it."""
    left_out: list[dict[str, object]]


class EdgesMessage(Message):
    """Towards what the image's edges lie: L and R, A and P, H and F."""

    left: str
    right: str
    top: str
    bottom: str


class SliceMessage(Message):
    """Where the pixels of a slice's picture lie."""

    width_px: int
    height_px: int
    pixel_mm: list[float]
    """Distance between columns and between rows; they may differ."""
    lps_from_px: list[list[float]]
    """3 rows of 3: (u, v, 1) to LPS in mm; the centre of the top-left pixel is (0, 0)."""
    normal_lps: list[float]
    """In which direction one looks."""
    edges: EdgesMessage
    at_mm: float | None
    """Of an axial, sagittal or coronal slice; null of others."""


class ProbeRequest(Message):
    """A point in the patient."""

    point_lps_mm: PointLps


class ProbeMessage(Message):
    """What the CT says at a point."""

    hu: float
    """Between voxels, linear; -1024 beyond the CT."""
    inside: bool
    index_ijk: list[float]
    """In the order of `size_ijk`."""


def upload_message(begun: ReadingBegun) -> UploadMessage:
    """An upload with its job, as it is told."""
    return UploadMessage(upload_id=begun.upload_id, **job_message(begun.job).model_dump())


def ct_message(heading: HeadingMessage, content: Mapping[str, object], volume: Volume) -> CtMessage:
    """The CT, as it is told."""
    return CtMessage(
        heading=heading,
        size_ijk=list(volume.shape_ijk),
        spacing_mm=volume.spacing_mm.tolist(),
        lps_from_ijk=volume.lps_from_ijk.tolist(),
        planes={plane: reach_message(volume, plane) for plane in VIEWS},
        presets={
            name: WindowMessage(window_hu=one.width_hu, level_hu=one.centre_hu)
            for name, one in WINDOWS.items()
        },
        description=mapping_of(content.get("description")),
        warnings=[str(one) for one in list_of(content.get("warnings"))],
        left_out=[mapping_of(one) for one in list_of(content.get("left_out"))],
    )


def reach_message(volume: Volume, plane: Plane) -> ReachMessage:
    """How far a plane can be moved, as it is told."""
    low, high, step = reach_mm(volume, plane)
    return ReachMessage(from_mm=low, to_mm=high, step_mm=step)


def slice_message(one: Slice, *, at_mm: float | None = None) -> SliceMessage:
    """Where a slice lies, as it is told."""
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
    """What a document holds as a mapping; an empty one where it holds something else."""
    return {str(key): one for key, one in value.items()} if isinstance(value, Mapping) else {}


def list_of(value: object) -> list[object]:
    """What a document holds as a list; an empty one where it holds something else."""
    return list(value) if isinstance(value, list | tuple) else []
