"""Messages of the rehearsal."""

from typing import TYPE_CHECKING, Annotated, TypeVar

from pydantic import Field

from server.config import RehearsalBoard, RehearsalEventConfig, RehearsalScene, RehearsalSkill
from server.stream.messages import Message
from tracker.geometry import Rigid

if TYPE_CHECKING:
    from tracker.rehearsal import Theatre, Truth

Matrix = list[list[float]]
Point = list[float]
To = TypeVar("To")
From = TypeVar("From")


class SceneRequest(Message):
    """Another scene in the same theatre; omitted values except events stay unchanged."""

    scene: RehearsalScene
    skill: RehearsalSkill | None = None
    board: RehearsalBoard | None = None
    events: Annotated[list[RehearsalEventConfig], Field(default_factory=list, max_length=20)]
    """Times are relative to the start of the scene."""


class TheatreLandmarkMessage(Message):
    """A named point on the bone."""

    name: str
    point_lps_mm: Point


class TheatreNeedleMessage(Message):
    """A needle in the bone."""

    tip_lps_mm: Point
    head_lps_mm: Point


class TheatreChannelMessage(Message):
    """A channel through the middle of a pedicle."""

    name: str
    entry_lps_mm: Point
    target_lps_mm: Point
    radius_mm: float


class MomentMessage(Message):
    """Ground truth of one image. Matrices are 4x4, mm."""

    image_number: int
    at_s: float
    """Time since the start of the scene."""
    phase: str
    """Phase of the simulated hand motion."""
    touched: str
    """The landmark at which the tip rests; empty if none."""
    marker_in_view: bool
    reference_in_view: bool
    camera_from_marker: Matrix
    camera_from_tool: Matrix
    camera_from_vertebra: Matrix
    """Registration to the camera; changes when patient or camera moves."""
    camera_from_reference: Matrix | None


class TheatreMessage(Message):
    """Ground truth of the theatre, independent of the scene."""

    landmarks: list[TheatreLandmarkMessage]
    """Captured in the scene `landmarks`, in this order."""
    check_landmark: TheatreLandmarkMessage
    """Captured in the scene `check`."""
    needles: list[TheatreNeedleMessage]
    channels: list[TheatreChannelMessage]
    camera_matrix: Matrix
    distortion: list[float]
    tip_in_marker_mm: Point
    axis_in_marker: Point
    reference_from_vertebra: Matrix | None
    """Registration to the patient marker."""
    moment: MomentMessage | None
    """Ground truth of the newest image; null before the first image of this scene."""


class RehearsalMessage(Message):
    """State of the rehearsal."""

    seed: int
    rate_hz: float
    reference: bool
    provides_setup: bool
    scene: str
    skill: str
    board: str
    events: list[RehearsalEventConfig]
    begun: bool
    """Whether images of this scene are available."""
    first_number: int | None
    """Number of its first image; `number = first_number + at_s * rate_hz`."""
    truth: TheatreMessage | None
    """Only on request, for tests and teaching."""


def theatre_message(theatre: "Theatre", moment: MomentMessage | None) -> TheatreMessage:
    """Return the ground truth of a theatre."""
    marker_from_tool = theatre.tool.marker_from_tool
    reference = None if theatre.reference is None else _matrix(theatre.reference_from_vertebra)
    check = theatre.check_landmark
    return TheatreMessage(
        landmarks=[
            TheatreLandmarkMessage(name=one.name, point_lps_mm=one.point_in_vertebra_mm.tolist())
            for one in theatre.landmarks
        ],
        check_landmark=TheatreLandmarkMessage(
            name=check.name, point_lps_mm=check.point_in_vertebra_mm.tolist()
        ),
        needles=[
            TheatreNeedleMessage(
                tip_lps_mm=needle.tip_in_vertebra_mm.tolist(), head_lps_mm=needle.head_in_vertebra_mm.tolist()
            )
            for needle in theatre.needles
        ],
        channels=[
            TheatreChannelMessage(
                name=channel.name,
                entry_lps_mm=channel.entry_in_vertebra_mm.tolist(),
                target_lps_mm=channel.target_in_vertebra_mm.tolist(),
                radius_mm=channel.radius_mm,
            )
            for channel in theatre.channels
        ],
        camera_matrix=theatre.camera.matrix.tolist(),
        distortion=theatre.camera.distortion.tolist(),
        tip_in_marker_mm=marker_from_tool.translation_mm.tolist(),
        axis_in_marker=marker_from_tool.rotation[:, 2].tolist(),
        reference_from_vertebra=reference,
        moment=moment,
    )


def moment_message(truth: "Truth", image_number: int) -> MomentMessage:
    """Return the ground truth of one image."""
    reference = truth.camera_from_reference
    return MomentMessage(
        image_number=image_number,
        at_s=truth.at_s,
        phase=truth.phase.value,
        touched=truth.touched,
        marker_in_view=truth.marker_in_view,
        reference_in_view=truth.reference_in_view,
        camera_from_marker=_matrix(truth.camera_from_marker),
        camera_from_tool=_matrix(truth.camera_from_tool),
        camera_from_vertebra=_matrix(truth.camera_from_vertebra),
        camera_from_reference=None if reference is None else _matrix(reference),
    )


def _matrix(rigid: Rigid[To, From]) -> Matrix:
    matrix: Matrix = rigid.matrix.tolist()
    return matrix
