"""Messages about the labels of vertebrae."""

from collections.abc import Mapping

from server.api.case_messages import HeadingMessage
from server.api.ct_messages import list_of, mapping_of
from server.api.remark_messages import RemarkMessage, stored_remark_messages
from server.live import Problem
from server.procedure.plan.repository import ChannelLevel
from server.stream.messages import Message, ProblemMessage, problem_message
from tracker.plan.labels import LabelOutline, StartPoint
from tracker.plan.pedicle import Side


class VertebraLabelMessage(Message):
    """The label of one vertebra."""

    level: str
    """C1 to S1."""
    volume_ml: float
    centroid_lps_mm: list[float]
    low_lps_mm: list[float]
    """Smallest coordinates of its voxels."""
    high_lps_mm: list[float]
    """Largest coordinates."""
    is_cut: bool
    """Whether it touches the border of the CT."""


class LabelsMessage(Message):
    """The labels of vertebrae in the CT of the open case."""

    heading: HeadingMessage
    source: str
    """nifti or dicom."""
    source_voxel_mm: list[float]
    """Voxel size of the segmentation, before it was resampled to the CT."""
    contrast_hu: float
    """Mean HU inside of the labels less that around them."""
    sha256: str
    """SHA-256 of the file of the labels."""
    vertebrae: list[VertebraLabelMessage]
    """From the head down."""
    warnings: list[RemarkMessage]


class StartPointMessage(Message):
    """Start of the measurement of one pedicle."""

    side: Side
    point_lps_mm: list[float]
    section_mm2: float
    """Area of the label's section there."""


class StartPointsMessage(Message):
    """Start points for the measurement of both pedicles of a level."""

    level: str
    starts: list[StartPointMessage]


class LabelOutlineMessage(Message):
    """Section of one label in a slice."""

    level: str
    rings_lps_mm: list[list[list[float]]]
    """Closed polygons."""
    name_lps_mm: list[float]
    """A point inside, where the name fits."""


class LabelOutlinesMessage(Message):
    """Sections of all labels in a slice."""

    outlines: list[LabelOutlineMessage]


class ChannelLevelMessage(Message):
    """In the label of which level a planned channel lies."""

    vertebra: str
    side: Side
    level: str
    """That of the vertebra; empty if nothing can be compared."""
    problem: ProblemMessage | None
    """LEVEL_DOUBTFUL if it lies in the label of another level."""


class ChannelLevelsMessage(Message):
    """All planned channels, compared with the labels."""

    channels: list[ChannelLevelMessage]


def start_points_message(level: str, starts: tuple[StartPoint, ...]) -> StartPointsMessage:
    """Return the message of start points."""
    return StartPointsMessage(
        level=level,
        starts=[
            StartPointMessage(
                side=one.side, point_lps_mm=one.point_lps_mm.tolist(), section_mm2=one.section_mm2
            )
            for one in starts
        ],
    )


def outlines_message(outlines: tuple[LabelOutline, ...]) -> LabelOutlinesMessage:
    """Return the message of outlines; coordinates are rounded to 0.01 mm."""
    return LabelOutlinesMessage(
        outlines=[
            LabelOutlineMessage(
                level=one.level,
                rings_lps_mm=[ring.round(2).tolist() for ring in one.rings_lps_mm],
                name_lps_mm=one.name_lps_mm.round(2).tolist(),
            )
            for one in outlines
        ]
    )


def channel_levels_message(channels: tuple[ChannelLevel, ...]) -> ChannelLevelsMessage:
    """Return the message of compared channels."""
    return ChannelLevelsMessage(
        channels=[
            ChannelLevelMessage(
                vertebra=one.vertebra,
                side=one.side,
                level=one.level,
                problem=problem_message(None if one.problem is None else Problem.from_error(one.problem)),
            )
            for one in channels
        ]
    )


def labels_message(heading: HeadingMessage, content: Mapping[str, object]) -> LabelsMessage:
    """Return the message of a document of labels."""
    return LabelsMessage.model_validate(
        {
            "heading": heading,
            "source": content.get("source"),
            "source_voxel_mm": list_of(content.get("source_voxel_mm")),
            "contrast_hu": content.get("contrast_hu"),
            "sha256": content.get("sha256"),
            "vertebrae": [mapping_of(one) for one in list_of(content.get("vertebrae"))],
            "warnings": stored_remark_messages(content.get("warnings")),
        }
    )
