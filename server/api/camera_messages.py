"""Messages of the camera calibration."""

from collections.abc import Mapping
from typing import Annotated, Literal, TypeAlias

from pydantic import Field

from server.api.case_messages import DocumentMessage
from server.api.ct_messages import list_of, mapping_of
from server.api.requester import MadeBy
from server.procedure.board_collection import BoardCollection, CollectionStatus
from server.stream.messages import Message, ProblemMessage, problem_message
from server.texts import phrase_text, requested_language
from tracker.camera import (
    AprilGridBoard,
    Board,
    CharucoBoard,
    CharucoLayout,
    CheckerBoard,
    DotBoard,
    DotLayout,
)

SHOW_IT = "Show the board to the camera."

Millimetres: TypeAlias = Annotated[float, Field(gt=0.0, le=1000.0, allow_inf_nan=False)]
Count: TypeAlias = Annotated[int, Field(ge=2, le=200)]


class DotsMessage(Message):
    """A grid of dots."""

    pattern: Literal["dots"]
    columns: Count
    rows: Count
    pitch_mm: Millimetres
    """Distance between neighbouring dots; asymmetric: half the distance of two dots in a row."""
    layout: DotLayout = DotLayout.SYMMETRIC
    fiducials: Annotated[tuple[int, ...], Field(max_length=1000)] = ()
    """Indexes of the larger dots, row by row from 0; default: detected."""


class CheckerboardMessage(Message):
    """A checkerboard."""

    pattern: Literal["checkerboard"]
    columns: Count
    """Inner corners in a row."""
    rows: Count
    """Rows of inner corners."""
    square_mm: Millimetres


class CharucoMessage(Message):
    """A checkerboard with markers."""

    pattern: Literal["charuco"]
    columns: Count
    """Squares in a row."""
    rows: Count
    """Rows of squares."""
    square_mm: Millimetres
    marker_mm: Millimetres
    dictionary: Annotated[str, Field(max_length=40)]
    """ArUco dictionary, as DICT_6X6_250."""
    layout: CharucoLayout | None = None
    """null: detected."""


class AprilGridMessage(Message):
    """A grid of AprilTags 36h11 as Kalibr prints it."""

    pattern: Literal["aprilgrid"]
    columns: Count
    """Tags in a row."""
    rows: Count
    """Rows of tags."""
    tag_mm: Millimetres
    """Side of a tag, black border included."""
    gap_mm: Millimetres
    """Gap between two tags."""


BoardMessage: TypeAlias = Annotated[
    DotsMessage | CheckerboardMessage | CharucoMessage | AprilGridMessage, Field(discriminator="pattern")
]


class CollectionRequest(Message):
    """Board to collect views of."""

    board: BoardMessage


class CollectionMessage(Message):
    """Progress of the collection of views."""

    board: BoardMessage
    running: bool
    """Whether views are being taken from the live images."""
    width_px: int
    height_px: int
    views: list[str]
    """Names of the stored views."""
    coverage_ratio: float
    """Fraction of the image covered by the board so far."""
    covered: list[list[bool]]
    """Coverage by image region, rows from the top."""
    tilt_deg: list[float]
    """Minimum and maximum pitch (> 0: upper edge away), minimum and maximum yaw (> 0: left edge away)."""
    missing: list[str]
    """Instructions for further views, in the language of the request; empty if the views suffice."""
    image_number: int
    """Number of the newest processed image; -1 if there is none."""
    is_taken: bool
    """Whether this image gave a view."""
    message: str
    """Result for this image, in the language of the request."""
    points_px: list[list[float]]
    """Detected board points in this image."""
    problem: ProblemMessage | None


class CameraStepMessage(Message):
    """State of the camera calibration in the open case."""

    collecting: bool
    """Whether a collection exists: see `/api/camera/collection`."""
    calibration: DocumentMessage | None
    """The newest one, valid or not; null if there is none."""
    accuracy: DocumentMessage | None
    """The newest accuracy check."""


class BoardFileRequest(Message):
    """A board to print."""

    board: BoardMessage
    paper: Literal["A4", "A3", "letter"] = "A4"
    file: Literal["pdf", "svg"] = "pdf"


class AccuracyRequest(Message):
    """The board in the live image, and who checks."""

    board: BoardMessage
    made_by: MadeBy


class CalibrationRequest(Message):
    """Who calibrates."""

    made_by: MadeBy


def board_of(message: BoardMessage) -> Board:
    """Return the board of a message.

    Raises:
        InvalidInput: BOARD_INVALID.
    """
    match message:
        case DotsMessage():
            return DotBoard(
                columns=message.columns,
                rows=message.rows,
                pitch_mm=message.pitch_mm,
                layout=message.layout,
                fiducials=message.fiducials,
            )
        case CheckerboardMessage():
            return CheckerBoard(columns=message.columns, rows=message.rows, square_mm=message.square_mm)
        case CharucoMessage():
            return CharucoBoard(
                columns=message.columns,
                rows=message.rows,
                square_mm=message.square_mm,
                marker_mm=message.marker_mm,
                dictionary=message.dictionary,
                layout=message.layout,
            )
        case AprilGridMessage():
            return AprilGridBoard(
                columns=message.columns, rows=message.rows, tag_mm=message.tag_mm, gap_mm=message.gap_mm
            )


def board_message(board: Board) -> BoardMessage:
    """Return the message of a board."""
    match board:
        case DotBoard():
            return DotsMessage(
                pattern="dots",
                columns=board.columns,
                rows=board.rows,
                pitch_mm=board.pitch_mm,
                layout=board.layout,
                fiducials=board.fiducials,
            )
        case CheckerBoard():
            return CheckerboardMessage(
                pattern="checkerboard", columns=board.columns, rows=board.rows, square_mm=board.square_mm
            )
        case CharucoBoard():
            return CharucoMessage(
                pattern="charuco",
                columns=board.columns,
                rows=board.rows,
                square_mm=board.square_mm,
                marker_mm=board.marker_mm,
                dictionary=board.dictionary,
                layout=board.layout,
            )
        case AprilGridBoard():
            return AprilGridMessage(
                pattern="aprilgrid",
                columns=board.columns,
                rows=board.rows,
                tag_mm=board.tag_mm,
                gap_mm=board.gap_mm,
            )


def collection_message(collection: BoardCollection) -> CollectionMessage:
    """Return the message of a collection."""
    status: CollectionStatus = collection.status
    progress = status.progress
    missing = (SHOW_IT,) if progress is None else progress.missing
    language = requested_language()
    return CollectionMessage(
        board=board_message(status.board),
        running=status.running,
        width_px=status.size_wh_px[0],
        height_px=status.size_wh_px[1],
        views=[one.name for one in collection.taken],
        coverage_ratio=0.0 if progress is None else progress.coverage_ratio,
        covered=[] if progress is None else progress.covered.tolist(),
        tilt_deg=[0.0] * 4 if progress is None else list(progress.tilt_deg),
        missing=[phrase_text("view_advice", one)[language] for one in missing],
        image_number=status.image_number,
        is_taken=status.is_taken,
        message=phrase_text("collection_message", status.message)[language],
        points_px=status.points_px.round(2).tolist(),
        problem=problem_message(status.problem),
    )


def worded_calibration(content: Mapping[str, object]) -> dict[str, object]:
    """Return a stored calibration with the reasons in its report in the language of the request."""
    report = mapping_of(content.get("report"))
    model = _with_worded_reason(mapping_of(report.get("model")), "model_reason")
    views = [_with_worded_reason(mapping_of(one), "view_fault") for one in list_of(report.get("views"))]
    return {**content, "report": {**report, "model": model, "views": views}}


def _with_worded_reason(values: dict[str, object], phrase: str) -> dict[str, object]:
    reason = str(values.get("reason", ""))
    return {**values, "reason": phrase_text(phrase, reason)[requested_language()] if reason else ""}
