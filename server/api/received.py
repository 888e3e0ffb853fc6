"""Series that a scanner or an archive sent by DICOM: list, take and discard."""

from fastapi import APIRouter

from server.api.ct_messages import UploadMessage, upload_message
from server.api.errors import STATUS_OF, rejections
from server.api.remark_messages import RemarkMessage, remark_message
from server.api.requester import MadeByQuery
from server.clock import SteadyClock
from server.dicom_receiver import DicomReceiver
from server.imaging.dicom_network.inbox import Inbox, ReceivedSeries, ReceivedUnknown
from server.procedure.ct import CtStep
from server.stream.messages import Message

STATUS_OF[ReceivedUnknown] = 404


class ReceivedSeriesMessage(Message):
    """A series that waits, without data that identify the patient."""

    id: str
    files: int
    size_mb: float
    age_s: float
    """Since its last slice."""
    complete: bool
    """Whether the sender has finished; only then it can be taken."""
    modality: str
    words: str
    """Series description of the scanner."""
    number: int
    size_wh_px: list[int]
    thickness_mm: float
    kernel: str
    unusable: str
    """Why it is not usable for planning; empty if no reason is known."""
    problem: RemarkMessage | None
    """Why it cannot be read."""


class ReceivedMessage(Message):
    """The series that wait."""

    address: str
    """AE title, host and port at which series are received; empty if that is off."""
    series: list[ReceivedSeriesMessage]
    remark: RemarkMessage | None
    """The last refusal."""


def received_router(step: CtStep, receiver: DicomReceiver | None) -> APIRouter:
    """Return the router of `/api/ct/received`. Its routes are synchronous because they read from the disk."""
    router = APIRouter(prefix="/api/ct/received", tags=["ct"])

    # Waiting series are not deleted because the computer's clock was set.
    clock = SteadyClock()

    def inbox() -> Inbox:
        if receiver is None:
            raise ReceivedUnknown(
                "RECEIVER_OFF",
                "no series are received, because dicom.receive.port is not set",
                "Set it in the settings, or upload the CT.",
            )
        return receiver.inbox

    @router.get("")
    def waiting() -> ReceivedMessage:
        """Return the series that wait, the newest first."""
        if receiver is None:
            return ReceivedMessage(address="", series=[], remark=None)
        status, now_s = receiver.status, clock().timestamp()
        return ReceivedMessage(
            address=f"{status.ae_title}@{status.host}:{status.port}",
            series=[_message(one, now_s) for one in receiver.inbox.waiting(now_s)],
            remark=None if status.remark is None else remark_message(status.remark),
        )

    @router.post("/{series_id}", status_code=202, responses=rejections(404, 409, 422, 503, 507))
    def take(series_id: str, made_by: MadeByQuery) -> UploadMessage:
        """Read a series as the CT of the open case, as after an upload. It waits until the CT is stored."""
        return upload_message(step.take(inbox(), series_id, made_by=made_by))

    @router.delete("/{series_id}", status_code=204, responses=rejections(404))
    def discard(series_id: str) -> None:
        """Delete a series that waits."""
        inbox().discard(series_id)

    return router


def _message(one: ReceivedSeries, now_s: float) -> ReceivedSeriesMessage:
    known = one.description
    return ReceivedSeriesMessage(
        id=one.id,
        files=one.files,
        size_mb=one.size_bytes / 1e6,
        age_s=max(0.0, now_s - one.changed_s),
        complete=known is not None or one.problem is not None,
        modality="" if known is None else known.modality,
        words="" if known is None else known.words,
        number=0 if known is None else known.number,
        size_wh_px=[0, 0] if known is None else list(known.size_wh_px),
        thickness_mm=0.0 if known is None else known.thickness_mm,
        kernel="" if known is None else known.kernel,
        unusable="" if known is None else known.problem,
        problem=None if one.problem is None else remark_message(one.problem),
    )
