"""What is asked and answered about calibrating the camera."""

from typing import Annotated, Literal, TypeAlias

from pydantic import Field

from server.api.case_messages import DocumentMessage
from server.api.doing import MadeBy
from server.procedure.board_collection import BoardCollection, CollectionStatus
from server.stream.messages import Message, ProblemMessage, problem_message
from tracker.camera import Board, CharucoBoard, CharucoLayout, CheckerBoard, DotBoard, DotLayout

SHOW_IT = "Show the board to the camera."

Millimetres: TypeAlias = Annotated[float, Field(gt=0.0, le=1000.0, allow_inf_nan=False)]
Count: TypeAlias = Annotated[int, Field(ge=2, le=200)]


class DotsMessage(Message):
    """A grid of dots."""

    pattern: Literal["dots"]
    columns: Count
    rows: Count
    pitch_mm: Millimetres
    """From a dot to the next; of an asymmetric board half the distance between two dots of a row."""
    layout: DotLayout = DotLayout.SYMMETRIC
    fiducials: Annotated[tuple[int, ...], Field(max_length=1000)] = ()
    """Indexes of the larger dots, row by row from 0; found by themselves where none are given."""


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
    """OpenCV's name, as DICT_6X6_250."""
    layout: CharucoLayout | None = None
    """Found out by itself where null."""


BoardMessage: TypeAlias = Annotated[
    DotsMessage | CheckerboardMessage | CharucoMessage, Field(discriminator="pattern")
]


class CollectionRequest(Message):
    """What to collect views of."""

    board: BoardMessage


class CollectionMessage(Message):
    """How far collecting views has come."""

    board: BoardMessage
    running: bool
    """Whether more views are taken by themselves."""
    width_px: int
    height_px: int
    views: list[str]
    """Names of the views that are kept."""
    coverage_ratio: float
    """How much of the image the board has been in."""
    covered: list[list[bool]]
    """The same part by part, rows from the top."""
    tilt_deg: list[float]
    """Least and most lean (upper edge away is above 0), least and most turn (left edge away is above 0)."""
    missing: list[str]
    """What to do next, in sentences; empty when there is enough."""
    image_number: int
    """Of the newest image that was looked at; -1 where there is none."""
    said: str
    """What became of that image."""
    points_px: list[list[float]]
    """Where the board was seen in it."""
    problem: ProblemMessage | None


class CameraStepMessage(Message):
    """How the camera's step stands in the open case."""

    collecting: bool
    """Whether views are held: see `/api/camera/collection`."""
    calibration: DocumentMessage | None
    """The newest, whether or not it holds; null where there is none."""
    accuracy: DocumentMessage | None
    """The newest check of the accuracy."""


class BoardFileRequest(Message):
    """A board to be printed."""

    board: BoardMessage
    paper: Literal["A4", "A3", "letter"] = "A4"
    file: Literal["pdf", "svg"] = "pdf"


class AccuracyRequest(Message):
    """A board that is in the picture now, and who checks."""

    board: BoardMessage
    made_by: MadeBy


class CalibrationRequest(Message):
    """Who calibrates."""

    made_by: MadeBy


def board_of(message: BoardMessage) -> Board:
    """The board that is described.

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


def board_message(board: Board) -> BoardMessage:
    """The description of a board."""
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


def collection_message(collection: BoardCollection) -> CollectionMessage:
    """How far a collection has come, as it is told."""
    status: CollectionStatus = collection.status
    progress = status.progress
    return CollectionMessage(
        board=board_message(status.board),
        running=status.running,
        width_px=status.size_wh_px[0],
        height_px=status.size_wh_px[1],
        views=[one.name for one in collection.taken],
        coverage_ratio=0.0 if progress is None else progress.coverage_ratio,
        covered=[] if progress is None else progress.covered.tolist(),
        tilt_deg=[0.0] * 4 if progress is None else list(progress.tilt_deg),
        missing=[SHOW_IT] if progress is None else list(progress.missing),
        image_number=status.image_number,
        said=status.said,
        points_px=status.points_px.round(2).tolist(),
        problem=problem_message(status.problem),
    )
