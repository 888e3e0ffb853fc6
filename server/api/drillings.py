"""Course of each drilling, from the recordings of the open case."""

from datetime import UTC, datetime

from fastapi import APIRouter

from server.api.errors import rejections
from server.api.jobs import JobMessage, job_message
from server.clock import utc_text
from server.recording.review import RecordedDrilling, RecordingReview
from server.stream.message import Message
from tracker.navigation.clearance import WallSource
from tracker.plan.screw import GertzbeinRobbins


class RecordedFigureMessage(Message):
    """A figure as it was displayed; null where unknown or undefined."""

    value: float | None
    error_95: float | None
    """Half width of the 95 % interval."""


class DrillingInstantMessage(Message):
    """Figures of one image; see `tracker.navigation.FigureName` for their units."""

    at_s: float
    """Time since the first image of the recording."""
    entry: RecordedFigureMessage
    angle: RecordedFigureMessage
    depth: RecordedFigureMessage
    wall: RecordedFigureMessage


class DrillingMessage(Message):
    """Drilling of one channel with one tool in one recording. Only images with displayed figures count."""

    recording: str
    is_whole: bool
    """false for an incomplete file: nothing is known of what came after its end."""
    began_at: str
    """Time of the first image with the tool in the bone; UTC, ISO 8601."""
    channel: str
    tool: str
    images: int
    """Images with figures of the tool in the bone."""
    from_s: float
    """Time of the first of them, since the first image of the recording."""
    to_s: float
    """Time of the last of them."""
    at_entry: DrillingInstantMessage
    """First image with figures after the tool last entered the bone before the deepest image."""
    deepest: DrillingInstantMessage
    """Image with the maximum depth of the tip."""
    nearest: DrillingInstantMessage
    """Image with the minimum clearance to a wall."""
    against: WallSource | None
    """What that clearance was measured against; null where unknown."""
    grade: GertzbeinRobbins | None
    """Gertzbein-Robbins grade of that clearance; null without a wall of bone."""
    worst_grade: GertzbeinRobbins | None
    """Grade at the lower limit of its 95 % interval; null where unknown."""
    missing_s: float
    """Time without figures while the tool was, or may have been, in the bone."""
    longest_missing_s: float
    """The longest of these periods."""


class DrillingsMessage(Message):
    """Drillings in the recordings of the open case, oldest first."""

    drillings: list[DrillingMessage]
    job: JobMessage | None
    """The job that reads the next recording; repeat the request when it ends. Null if all are read."""
    unread: list[str]
    """Recordings that could not be read."""
    running: int
    """Number of recordings that are being written, which are not read."""


def drillings_router(review: RecordingReview) -> APIRouter:
    """Return the router of `/api/recordings/drillings`; synchronous, because it waits for the disk."""
    router = APIRouter(prefix="/api/recordings", tags=["recordings"])

    @router.get("/drillings", responses=rejections(409, 503))
    def drillings() -> DrillingsMessage:
        """Return the course of each drilling in the recordings of the open case.

        A recording that was not reviewed yet is read first, in a job, one recording after the other.
        """
        found = review.drillings()
        return DrillingsMessage(
            drillings=[_drilling(one) for one in found.courses],
            job=None if found.job is None else job_message(found.job),
            unread=list(found.unread),
            running=found.running,
        )

    return router


def _drilling(drilling: RecordedDrilling) -> DrillingMessage:
    course, summary = drilling.course, drilling.summary
    begin = datetime.fromtimestamp(summary.begin_unix_s + course.from_s, tz=UTC)
    instants = {
        name: DrillingInstantMessage.model_validate(getattr(course, name), from_attributes=True)
        for name in ("at_entry", "deepest", "nearest")
    }
    return DrillingMessage(
        recording=drilling.recording,
        is_whole=summary.is_whole,
        began_at=utc_text(begin),
        channel=course.channel,
        tool=course.tool,
        images=course.images,
        from_s=course.from_s,
        to_s=course.to_s,
        against=course.against,
        grade=course.grade,
        worst_grade=course.worst_grade,
        missing_s=course.missing_s,
        longest_missing_s=course.longest_missing_s,
        **instants,
    )
