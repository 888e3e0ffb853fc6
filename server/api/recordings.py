"""Recordings of the open case: start, stop, list, download, protect and delete."""

from pathlib import Path
from typing import Annotated, Literal

from fastapi import APIRouter, Request, Response
from fastapi.responses import FileResponse, StreamingResponse
from pydantic import Field

from server.api.errors import rejections
from server.api.jobs import JobMessage, job_message
from server.recording.consent import Consent, ConsentState
from server.recording.export import Table, csv_lines
from server.recording.exports import VIDEO_SUFFIX, RecordingExports
from server.recording.service import RecordingService, StoredRecording
from server.security.audit import note
from server.security.person import person_of
from server.stream.message import Message
from server.stream.messages import ProblemMessage, problem_message
from server.texts import Language

MCAP = "application/octet-stream"
MP4 = "video/mp4"
CSV = "text/csv"


class ConsentMessage(Message):
    """Whether the patient of the open case consented to recordings."""

    state: ConsentState
    """Recordings start only with given or not_required."""
    answered_at: str | None
    """UTC, ISO 8601; null without an answer."""
    answered_by: str | None


class ConsentRequest(Message):
    """Whether the patient consented."""

    case_id: Annotated[str, Field(min_length=1, max_length=64)]
    """The case for which this was requested."""
    is_given: bool


class RecordingStateMessage(Message):
    """What is being recorded."""

    when: Literal["navigating", "manual", "never"]
    """When recordings start: by themselves, when somebody starts one, or never."""
    consent: ConsentMessage
    is_recording: bool
    name: str | None
    """Of the running recording; null without one."""
    duration_s: float
    size_bytes: int
    images: int
    missing_images: int
    """Tracked images that are not in the file; a replay is not exact until some seconds after them."""
    remaining_s: float | None
    """How long disk and budget last at the present rate; null where unknown."""
    problem: ProblemMessage | None
    """Why the last recording ended by itself; null if it did not."""


class RecordingMessage(Message):
    """One recording."""

    name: str
    began_at: str
    """UTC, ISO 8601."""
    duration_s: float | None
    """Null while it runs, and for a file that was cut by a crash and is readable up to there."""
    size_bytes: int
    is_protected: bool
    is_running: bool


class RecordingsMessage(Message):
    """The recordings of the open case, the oldest first."""

    recordings: list[RecordingMessage]


class VideoRequest(Message):
    """The video of a recording."""

    language: Language = "en"
    """Of the words in it."""


class CutRequest(Message):
    """A part of a recording, in s since its first image."""

    from_s: Annotated[float, Field(ge=0.0, le=1e7, allow_inf_nan=False)]
    to_s: Annotated[float, Field(ge=0.0, le=1e7, allow_inf_nan=False)]


class ExportMessage(Message):
    """A video or a piece of a recording."""

    file: str
    """Its name, to be downloaded by."""
    size_bytes: int


class ExportsMessage(Message):
    """What was made from a recording, and is being made."""

    files: list[ExportMessage]
    job: JobMessage | None
    """The newest for this recording; null if the server remembers none."""


class ProtectionMessage(Message):
    """Whether a recording is protected from deletion."""

    is_protected: bool


def recordings_router(service: RecordingService) -> APIRouter:
    """Return the router of `/api/recordings`. Its routes are synchronous because they wait for the disk."""
    router = APIRouter(prefix="/api/recordings", tags=["recordings"])

    @router.get("", responses=rejections(409, 503))
    def recordings() -> RecordingsMessage:
        """Return the recordings of the open case."""
        return RecordingsMessage(recordings=[_recording(one) for one in service.list()])

    @router.get("/state", responses=rejections(503))
    def state() -> RecordingStateMessage:
        """Return what is being recorded, in any case."""
        return recording_state_message(service)

    @router.post("/start", responses=rejections(409, 503, 507))
    def start() -> RecordingStateMessage:
        """Start a recording of the open case; a running one goes on.

        It has every tracked image with the state before it, so that `coaxial replay --check` gives the same
        results again. Where the settings require it, somebody has to state the patient's consent first. Where
        the disk or the budget ends, the recording stops with an alarm, and navigation goes on.
        """
        service.start()
        return recording_state_message(service)

    @router.post("/consent", responses=rejections(409, 422, 503, 507))
    def consent(answer: ConsentRequest, request: Request) -> ConsentMessage:
        """State whether the patient consented to recordings of the open case.

        The answer is stored in the case with its author. A recording that runs without consent is ended.
        """
        before = service.consent.state
        stored = service.answer_consent(
            answer.case_id, is_given=answer.is_given, made_by=person_of(request.scope).name
        )
        note({"what": "consent", "case_id": answer.case_id, "from": before.value, "to": stored.state.value})
        return _consent(stored)

    @router.post("/stop", responses=rejections(503))
    def stop() -> RecordingStateMessage:
        """Stop the recording; the answer comes when its file is closed."""
        service.stop()
        return recording_state_message(service)

    @router.get("/{name}/file", response_class=FileResponse, responses=rejections(404, 409, 503))
    def download(name: str) -> FileResponse:
        """Return the file of a recording (MCAP). It has images of the operation and names of staff."""
        return FileResponse(service.path(name), media_type=MCAP, filename=name)

    @router.get(
        "/{name}/export/{table}.csv",
        response_class=StreamingResponse,
        responses=rejections(404, 409, 422, 503),
    )
    def export(name: str, table: Table) -> StreamingResponse:
        """Return poses, deviations or alarms of a recording as CSV; the guide describes the columns."""
        headers = {"Content-Disposition": f'attachment; filename="{Path(name).stem}-{table}.csv"'}
        return StreamingResponse(csv_lines(service.path(name), table), media_type=CSV, headers=headers)

    @router.put("/{name}/protection", responses=rejections(404, 409, 503))
    def protect(name: str, requested: ProtectionMessage) -> ProtectionMessage:
        """Protect a recording from deletion, or end that. It is deleted with its case all the same."""
        service.protect(name, is_protected=requested.is_protected)
        return requested

    @router.delete("/{name}", status_code=204, responses=rejections(404, 409, 503))
    def delete(name: str) -> Response:
        """Delete a recording that is neither protected nor running."""
        service.delete(name)
        return Response(status_code=204)

    return router


def recording_exports_router(exports: RecordingExports) -> APIRouter:
    """Return the router of what is made from recordings, by jobs."""
    router = APIRouter(prefix="/api/recordings/{name}", tags=["recordings"])

    @router.post("/video", status_code=202, responses=rejections(404, 409, 422, 503, 507))
    def video(name: str, requested: VideoRequest) -> JobMessage:
        """Write a recording as a video (MP4) with the overlay, in a job.

        Its result has `file`, to be downloaded, `images`, `gaps` (times without an image, shown as such) and
        `undrawn` (images that say why they are without results). Needs PyAV.
        """
        return job_message(exports.start_video(name, requested.language))

    @router.post("/cut", status_code=202, responses=rejections(404, 409, 422, 503, 507))
    def cut(name: str, requested: CutRequest) -> JobMessage:
        """Cut out a part of a recording as a recording that replays exactly, in a job.

        It begins at the stored state of tracking before `from_s`, up to a minute earlier: `from_s` of the
        result. `is_exact` is false where none is stored, and `missing_images` were not recorded between its
        `images`; `file` is to be downloaded.
        """
        return job_message(exports.start_cut(name, requested.from_s, requested.to_s))

    @router.get("/exports", responses=rejections(404, 409, 503))
    def made(name: str) -> ExportsMessage:
        """Return the video and the piece that were made from a recording, and the newest job for one."""
        found = exports.exports(name)
        return ExportsMessage(
            files=[ExportMessage.model_validate(one, from_attributes=True) for one in found.files],
            job=None if found.job is None else job_message(found.job),
        )

    @router.get("/exports/{file}", response_class=FileResponse, responses=rejections(404, 409, 503))
    def download(name: str, file: str) -> FileResponse:
        """Return a file that a job made. It has images of the operation."""
        path = exports.path(name, file)
        kind = MP4 if path.suffix == VIDEO_SUFFIX else MCAP
        return FileResponse(path, media_type=kind, filename=file)

    return router


def _recording(recording: StoredRecording) -> RecordingMessage:
    return RecordingMessage.model_validate(recording, from_attributes=True)


def _consent(consent: Consent) -> ConsentMessage:
    return ConsentMessage(
        state=consent.state,
        answered_at=consent.answered_at or None,
        answered_by=consent.answered_by or None,
    )


def recording_state_message(service: RecordingService) -> RecordingStateMessage:
    """Return the message of what is being recorded."""
    state = service.state
    status = state.status
    return RecordingStateMessage(
        when=service.when,
        consent=_consent(service.consent),
        is_recording=bool(state.name),
        name=state.name or None,
        duration_s=state.duration_s,
        size_bytes=0 if status is None else status.written_bytes,
        images=0 if status is None else status.images,
        missing_images=0 if status is None else status.missing_images,
        remaining_s=state.remaining_s,
        problem=problem_message(state.problem),
    )
