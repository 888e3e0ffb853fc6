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
from server.recording.exports import RecordingExports
from server.recording.service import RecordingService, StoredRecording
from server.security.audit import note
from server.security.person import person_of
from server.stream.message import Message
from server.stream.messages import ProblemMessage, problem_message
from server.texts import Language

BYTES = "application/octet-stream"
CSV = "text/csv"
KINDS = {".mp4": "video/mp4", ".zip": "application/zip"}


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
    """State of the recording."""

    when: Literal["navigating", "manual", "never"]
    """When recordings start: automatically, on request, or never."""
    consent: ConsentMessage
    is_recording: bool
    name: str | None
    """Start of the running recording; null without one."""
    duration_s: float
    size_bytes: int
    images: int
    missing_images: int
    """Tracked images that are not in the file; a replay is not exact until some seconds after them."""
    remaining_s: float | None
    """Time until disk or budget are used up at the present rate; null if unknown."""
    problem: ProblemMessage | None
    """Why the last recording ended without a request; null if it did not."""


class RecordingMessage(Message):
    """One recording."""

    name: str
    began_at: str
    """UTC, ISO 8601."""
    duration_s: float | None
    """null while it runs, and for an incomplete file after a crash, which is readable up to its end."""
    size_bytes: int
    is_protected: bool
    is_running: bool


class RecordingsMessage(Message):
    """The recordings of the open case, oldest first."""

    recordings: list[RecordingMessage]


class VideoRequest(Message):
    """Video of a recording to write."""

    language: Language = "en"
    """Language of the texts in it."""


class CutRequest(Message):
    """A part of a recording, in s since its first image."""

    from_s: Annotated[float, Field(ge=0.0, le=1e7, allow_inf_nan=False)]
    to_s: Annotated[float, Field(ge=0.0, le=1e7, allow_inf_nan=False)]


class ExportMessage(Message):
    """A file made from a recording."""

    file: str
    """File name for the download."""
    size_bytes: int


class ExportsMessage(Message):
    """Exports of a recording, complete and in progress."""

    files: list[ExportMessage]
    job: JobMessage | None
    """The newest job for this recording; null if there is none."""


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
        """Return the state of the recording, whichever case it belongs to."""
        return recording_state_message(service)

    @router.post("/start", responses=rejections(409, 503, 507))
    def start() -> RecordingStateMessage:
        """Start a recording of the open case; a running recording continues.

        It contains every tracked image with the state before it, so that `coaxial replay --check` reproduces
        the results. If the settings require it, the patient's consent must be stated first. When disk or
        budget are used up, the recording stops with an alarm; navigation continues.
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
        """Stop the recording; the response is sent when its file is closed."""
        service.stop()
        return recording_state_message(service)

    @router.get("/{name}/file", response_class=FileResponse, responses=rejections(404, 409, 503))
    def download(name: str) -> FileResponse:
        """Return the file of a recording (MCAP). It contains images of the operation and names of staff."""
        return FileResponse(service.path(name), media_type=BYTES, filename=name)

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
        """Protect a recording from deletion, or remove the protection. It is still deleted with its case."""
        service.protect(name, is_protected=requested.is_protected)
        return requested

    @router.delete("/{name}", status_code=204, responses=rejections(404, 409, 503))
    def delete(name: str) -> Response:
        """Delete a recording that is neither protected nor running."""
        service.delete(name)
        return Response(status_code=204)

    return router


def recording_exports_router(exports: RecordingExports) -> APIRouter:
    """Return the router of the exports of recordings, which are made by jobs."""
    router = APIRouter(prefix="/api/recordings/{name}", tags=["recordings"])

    @router.post("/video", status_code=202, responses=rejections(404, 409, 422, 503, 507))
    def video(name: str, requested: VideoRequest) -> JobMessage:
        """Write a recording as a video (MP4) with the overlay, in a job.

        Its result contains `file` for the download, `images`, `gaps` (periods without images, marked as such)
        and `images_without_overlay` (images without recorded results, marked with the reason). Requires PyAV.
        """
        return job_message(exports.start_video(name, requested.language))

    @router.post("/cut", status_code=202, responses=rejections(404, 409, 422, 503, 507))
    def cut(name: str, requested: CutRequest) -> JobMessage:
        """Write a part of a recording as a recording that replays exactly, in a job.

        It starts at the stored tracking state before `from_s`, up to a minute earlier; `from_s` of the result
        is its start. `is_exact` is false if no state is stored there. `missing_images` is the number of
        images between its `images` that were not recorded. `file` is for the download.
        """
        return job_message(exports.start_cut(name, requested.from_s, requested.to_s))

    @router.post("/tables", status_code=202, responses=rejections(404, 409, 422, 503, 507))
    def tables(name: str) -> JobMessage:
        """Write the tables of a recording as Parquet, in one zip archive, in a job.

        They have the columns of the CSV, with types and units. Its result contains `file` for the download
        and the number of `rows`. Requires pyarrow.
        """
        return job_message(exports.start_tables(name))

    @router.post("/sequence", status_code=202, responses=rejections(404, 409, 422, 503, 507))
    def sequence(name: str, requested: CutRequest) -> JobMessage:
        """Write images and poses of a part of a recording as a sequence metafile (.igs.mha), in a job.

        Its result contains `file` for the download, `images`, `invalid_images` (not decodable, black),
        `from_s`, `to_s`, and `frames`: the coordinate frame of each tool, marker and vertebra.
        """
        return job_message(exports.start_sequence(name, requested.from_s, requested.to_s))

    @router.get("/exports", responses=rejections(404, 409, 503))
    def made(name: str) -> ExportsMessage:
        """Return the files made from a recording, and the newest job for it."""
        found = exports.exports(name)
        return ExportsMessage(
            files=[ExportMessage.model_validate(one, from_attributes=True) for one in found.files],
            job=None if found.job is None else job_message(found.job),
        )

    @router.get("/exports/{file}", response_class=FileResponse, responses=rejections(404, 409, 503))
    def download(name: str, file: str) -> FileResponse:
        """Return an exported file. It contains images of the operation."""
        path = exports.path(name, file)
        return FileResponse(path, media_type=KINDS.get(path.suffix, BYTES), filename=file)

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
    """Return the message of the recording state."""
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
