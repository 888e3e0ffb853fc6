"""Review of recordings: timeline and single images."""

from collections.abc import Sequence
from datetime import UTC, datetime
from typing import Annotated, Literal

from fastapi import APIRouter, Path, Query, Request, Response, WebSocket, status
from pydantic import Field, StringConstraints, ValidationError

from server.api.errors import rejections
from server.api.jobs import JobMessage, job_message
from server.clock import utc_text
from server.jobs import Job
from server.number_format import finite
from server.recording.comments import MAX_TEXT_LENGTH, Comment, RecordingComments
from server.recording.review import RecordingReview, Samples, other_version, sampled
from server.recording.review_scenes import ReviewScenes
from server.recording.timeline import FIGURES, STATUSES, EventKind, RecordingIndex, TimelineEvent
from server.security.person import person_of
from server.stream.alarm_messages import AlarmsMessage
from server.stream.assessment_messages import TextMessage, text_message
from server.stream.message import Message
from server.stream.snapshot_messages import SnapshotMessage
from server.texts import LANGUAGES, STATES, Text, alarm_title
from tracker.navigation import AbsentReason, Status
from tracker.navigation.alarms import ALARM_RULES, Condition, Priority

MAX_SAMPLES = 4000
# A recording of another version may contain reasons without a title here.
CONDITIONS = {one.value: one for one in Condition}
REASONS = {one.value: one for one in AbsentReason}
# The images of a recording do not change.
CACHE = {"Cache-Control": "private, max-age=3600"}


class RecordedEventMessage(Message):
    """An event or a period of a recording."""

    kind: EventKind | Literal["comment"]
    """navigation: navigation was on; withheld: no figures; step: a new document of the case; note: a remark
    on the recording itself."""
    from_s: float
    """Time since the first image, like all times here."""
    to_s: float | None
    """null for an event without duration."""
    code: str
    """Condition of an alarm, reason of withheld figures, code of a note, shape of a mark, kind of a document,
    id of a comment."""
    title: TextMessage | None
    """Title of an alarm or of withheld figures, in capitals; text of a comment; otherwise null."""
    priority: Priority | None
    """Priority of an alarm; otherwise null."""
    by: str
    """Person who caused it; empty if nobody did."""


class CurveMessage(Message):
    """Values of one figure; null where withheld or undefined."""

    values: list[float | None]
    limits: list[float | None]
    statuses: list[Status | None]


class CurvesMessage(Message):
    """The displayed figures; a sample of several images has the worst of each, and the newest depth."""

    numbers: list[int]
    """Time of the first image of each sample."""
    at_s: list[float]
    entry: CurveMessage
    angle: CurveMessage
    depth: CurveMessage
    wall: CurveMessage
    risk: CurveMessage
    """%, probability that the drill is through a wall, now or 2 mm further."""


class TimelineMessage(Message):
    """Content of a recording."""

    began_at: str
    """Time of the first image; UTC, ISO 8601."""
    duration_s: float
    images: int
    is_whole: bool
    """false for an incomplete file, which is readable up to its end."""
    events: list[RecordedEventMessage]
    curves: CurvesMessage
    """Figures between the requested times."""


class RecordingReviewMessage(Message):
    """The timeline, or the job that prepares it; exactly one of them is null."""

    job: JobMessage | None
    timeline: TimelineMessage | None


class RecordedInstantMessage(Message):
    """One image of a recording with its results."""

    number: int
    at_s: float
    snapshot: SnapshotMessage
    alarms: AlarmsMessage | None
    """null if they were not recorded."""


class NearestImageMessage(Message):
    """The image of a recording nearest to a time."""

    number: int
    at_s: float
    """Its time since the first image."""


class RecordedSceneRequest(Message):
    """The instant that a 3-D scene shows."""

    number: Annotated[int, Field(ge=0)]
    """Index of the image in the recording, from 0."""


class RecordedSceneMessage(Message):
    """The instant that a 3-D scene shows."""

    image_number: int
    """Number of the image, as drawn in the scene."""


class CommentRequest(Message):
    """A comment on an instant of a recording."""

    at_s: Annotated[float, Field(ge=0.0, le=1e7, allow_inf_nan=False)]
    """Time since the first image."""
    text: Annotated[
        str,
        StringConstraints(
            strip_whitespace=True, min_length=1, max_length=MAX_TEXT_LENGTH, pattern=r"^[^\x00-\x1f]+$"
        ),
    ]
    """One line."""


class CommentMessage(Message):
    """A comment, as stored in the case."""

    document_id: str
    at_s: float
    text: str
    made_at: str
    """UTC, ISO 8601."""
    made_by: str


Seconds = Annotated[float, Query(ge=0.0, le=1e7)]
Number = Annotated[int, Path(ge=0, description="Index of the image in the recording, from 0.")]


Key = Annotated[str, Path(pattern=r"^[0-9a-f]{16,64}$", description="Chosen at random by the page.")]


def review_scenes_router(scenes: ReviewScenes) -> APIRouter:
    """Return the router of the 3-D scenes of recordings."""
    router = APIRouter(tags=["recordings"])

    @router.get("/scene/review/{key}/", include_in_schema=False)
    async def scene_page(key: Key, request: Request) -> Response:
        scene = scenes.get(key)
        return Response(status_code=404) if scene is None else await scene.answer(request)

    # The page of viser removes the slash.
    @router.websocket("/scene/review/{key}")
    async def scene_socket(key: str, websocket: WebSocket) -> None:
        scene = scenes.get(key)
        if scene is None:
            await websocket.close(status.WS_1008_POLICY_VIOLATION)
        else:
            await scene.watch(websocket)

    @router.put("/api/recordings/{name}/scenes/{key}", responses=rejections(404, 409, 422, 503))
    async def show(name: str, key: Key, requested: RecordedSceneRequest) -> RecordedSceneMessage:
        """Show an image in the 3-D scene `/scene/review/{key}/`, which is created with the first one."""
        return RecordedSceneMessage(image_number=await scenes.show(key, name, requested.number))

    return router


def recording_review_router(review: RecordingReview, comments: RecordingComments) -> APIRouter:
    """Return the router of the contents of recordings; synchronous, because it waits for the disk."""
    router = APIRouter(prefix="/api/recordings/{name}", tags=["recordings"])

    @router.get("/timeline", responses=rejections(404, 409, 422, 503))
    def timeline(
        name: str,
        from_s: Seconds = 0.0,
        to_s: Seconds = 1e7,
        samples: Annotated[int, Query(ge=1, le=MAX_SAMPLES)] = 1000,
    ) -> RecordingReviewMessage:
        """Return the events of a recording, and its figures between two times.

        The first request starts a job that reads the recording; repeat the request when the job is done.
        """
        index = review.index(name)
        if isinstance(index, Job):
            return RecordingReviewMessage(job=job_message(index), timeline=None)
        end_s = float(index.at_s[-1]) if len(index) else 0.0
        return RecordingReviewMessage(
            job=None,
            timeline=_timeline(index, sampled(index, from_s, min(to_s, end_s), samples), comments.all(name)),
        )

    @router.post("/comments", status_code=201, responses=rejections(404, 409, 422, 503, 507))
    def comment(name: str, requested: CommentRequest, request: Request) -> CommentMessage:
        """Comment on an instant; the comment is stored in the case with its author and shown in the timeline.

        To remove it, withdraw its document.
        """
        stored = comments.add(
            name, at_s=requested.at_s, text=requested.text, made_by=person_of(request.scope).name
        )
        return CommentMessage.model_validate(stored, from_attributes=True)

    @router.get("/images/{number}.jpg", response_class=Response, responses=rejections(404, 409, 422, 503))
    def image(name: str, number: Number) -> Response:
        """Return an image as JPEG, without overlay."""
        return Response(review.jpeg(name, number), media_type="image/jpeg", headers=CACHE)

    @router.get("/nearest", responses=rejections(404, 409, 422, 503))
    def nearest(name: str, at_s: Seconds) -> NearestImageMessage:
        """Return the image nearest to a time since the first image."""
        number, found_s = review.nearest(name, at_s)
        return NearestImageMessage(number=number, at_s=found_s)

    @router.get("/instants/{number}", responses=rejections(404, 409, 422, 503))
    def instant(name: str, number: Number) -> RecordedInstantMessage:
        """Return the results of an image, and the alarms after it."""
        found = review.instant(name, number)
        try:
            return RecordedInstantMessage(
                number=number,
                at_s=found.at_s,
                snapshot=SnapshotMessage.model_validate_json(found.snapshot),
                alarms=AlarmsMessage.model_validate_json(found.alarms) if found.alarms else None,
            )
        except ValidationError as error:
            raise other_version(name, number, error) from None

    return router


def _timeline(index: RecordingIndex, samples: Samples, comments: Sequence[Comment]) -> TimelineMessage:
    events = [*(_event(one) for one in index.events), *(_comment_event(one) for one in comments)]
    return TimelineMessage(
        began_at=utc_text(datetime.fromtimestamp(index.begin_unix_s, tz=UTC)),
        duration_s=float(index.at_s[-1]) if len(index) else 0.0,
        images=len(index),
        is_whole=index.is_whole,
        events=sorted(events, key=lambda event: event.from_s),
        curves=CurvesMessage(
            numbers=samples.numbers.tolist(),
            at_s=samples.at_s.tolist(),
            **{name: _curve(samples, column) for column, name in enumerate(FIGURES)},
        ),
    )


def _event(event: TimelineEvent) -> RecordedEventMessage:
    condition = CONDITIONS.get(event.code)
    reason = REASONS.get(event.code)
    title: Text | None = None
    if condition is not None:
        title = alarm_title(condition)
    elif reason is not None:
        title = {language: STATES[language][reason].title for language in LANGUAGES}
    return RecordedEventMessage(
        kind=event.kind,
        from_s=event.from_s,
        to_s=event.to_s,
        code=event.code,
        title=None if title is None else text_message(title),
        priority=None if condition is None or event.kind != "alarm" else ALARM_RULES[condition].priority,
        by=event.by,
    )


def _comment_event(comment: Comment) -> RecordedEventMessage:
    return RecordedEventMessage(
        kind="comment",
        from_s=comment.at_s,
        to_s=None,
        code=comment.document_id,
        title=TextMessage(en=comment.text, de=comment.text),
        priority=None,
        by=comment.made_by,
    )


def _curve(samples: Samples, column: int) -> CurveMessage:
    return CurveMessage(
        values=[finite(one) for one in samples.values[:, column].tolist()],
        limits=[finite(one) for one in samples.limits[:, column].tolist()],
        statuses=[None if one < 0 else STATUSES[one] for one in samples.statuses[:, column].tolist()],
    )
