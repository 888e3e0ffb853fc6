"""Guided accuracy test: captures of a tool in the divots of a plate, and its certificate."""

from typing import Annotated, TypeAlias

from fastapi import APIRouter, Response
from pydantic import Field

from server.api.errors import rejections
from server.api.requester import MadeBy
from server.certificate import (
    CertifiedAudit,
    PlateFile,
    plate_file_in,
    printed_plate,
    printed_sheet,
    round_up,
)
from server.config import Name
from server.printing import pdf_from_sheet
from server.procedure.accuracy import AccuracyStep, MeasuredPlate
from server.procedure.accuracy_collection import AccuracyStatus
from server.procedure.divot_capture import DivotCaptureState, PlannedCapture
from server.security.audit.files import read_head_of
from server.store import Home
from server.stream.messages import Message, ProblemMessage, problem_message, translated_problem
from tracker.accuracy import DivotCapture

Label: TypeAlias = Annotated[str, Field(min_length=1, max_length=20)]
RulerMm: TypeAlias = Annotated[float, Field(gt=0.0, le=1250.0, allow_inf_nan=False)]


class AccuracyTestRequest(Message):
    """Tool and plate of an accuracy test."""

    tool: Name
    plate: Annotated[str, Field(min_length=1, max_length=20_000)] | None = None
    """Text of a plate file, YAML or JSON; null is the printed plate of `/api/certificates/plate.pdf`."""
    rulers_mm: tuple[RulerMm, RulerMm] | None = None
    """Measured lengths of the rulers across and down the page; null for a plate without rulers."""
    ruler_sd_mm: Annotated[float, Field(ge=0.001, le=5.0)] = 0.2
    """Standard deviation of these lengths: 0.1 with calipers, 0.2 with a steel ruler."""


class PlannedCaptureMessage(Message):
    """A capture of the plan."""

    placement: Label
    """Where the plate lies: near, (middle,) far."""
    divot: Label
    posture: Label
    """How the tool is held: upright, tilted or turned."""


class DivotMessage(Message):
    """A divot of the plate that is captured."""

    name: str
    x_mm: float
    y_mm: float
    taken: int
    """Captures in the present placement of the plate."""


class TakenCaptureMessage(PlannedCaptureMessage):
    """A capture that is taken."""

    images: int
    jitter_mm: float
    """RMS distance of the tips of its images from their mean."""
    jitter_deg: float


class DivotCaptureMessage(PlannedCaptureMessage):
    """The active or last capture."""

    state: DivotCaptureState
    seen: int
    """Images in which the tip was measured."""
    images: int
    problem: ProblemMessage | None
    """Why it was rejected."""


class AccuracyTestMessage(Message):
    """Progress of an accuracy test."""

    tool: str
    marker: str
    plate: str
    divots: list[DivotMessage]
    planned: int
    """Number of captures of the test, fixed before the first."""
    taken: int
    due: PlannedCaptureMessage | None
    """The next capture; null if all are taken."""
    last: TakenCaptureMessage | None
    """The last capture that was taken."""
    capture: DivotCaptureMessage | None
    error_95_mm: float | None
    """Of a complete test: with a confidence of 95 %, 95 % of single tips are this near to the truth."""
    problems: list[ProblemMessage]
    """What speaks against a certificate of a complete test."""


class CertificateRequest(Message):
    """Issue the certificate."""

    made_by: MadeBy
    valid_days: Annotated[int, Field(ge=1, le=366)] = 90


class IssuedCertificateMessage(Message):
    """The certificate that was issued and installed."""

    marker: str
    error_95_mm: float
    valid_until: str
    """UTC, ISO 8601."""


def accuracy_router(step: AccuracyStep, home: Home) -> APIRouter:
    """Return the router of the guided test. Its routes are synchronous because they read and compute."""
    router = APIRouter(prefix="/api/certificates", tags=["tools"])

    @router.get(
        "/plate.pdf",
        response_class=Response,
        responses={200: {"content": {"application/pdf": {}}}},
    )
    def plate() -> Response:
        """Return the printed plate, nine numbered crosses and two rulers on A4. Print it at 100 %."""
        content = pdf_from_sheet(printed_sheet(printed_plate()))
        return Response(content, media_type="application/pdf")

    @router.post("/collection", status_code=201, responses=rejections(404, 409, 422, 503))
    def begin(requested: AccuracyTestRequest) -> AccuracyTestMessage:
        """Begin an accuracy test of a tool with the camera of the newest image; a previous one is discarded.

        A printed plate needs the measured lengths of its rulers.
        """
        file = _plate(requested.plate)
        measured = MeasuredPlate(file=file, rulers_mm=requested.rulers_mm, ruler_sd_mm=requested.ruler_sd_mm)
        return _message(step.begin(requested.tool, measured).status)

    @router.get("/collection", responses=rejections(409))
    def progress() -> AccuracyTestMessage:
        """Return the captures, what is due next, and of a complete test the figures and problems."""
        return _message(step.collection.status)

    @router.delete("/collection", status_code=204)
    def end() -> Response:
        """End the test and discard its captures."""
        step.end()
        return Response(status_code=204)

    @router.post("/collection/captures", status_code=202, responses=rejections(409, 422))
    def capture(requested: PlannedCaptureMessage) -> AccuracyTestMessage:
        """Capture the tip at rest from the images of the next second; only the one that is due is accepted.

        It is rejected if the tip moves, is not seen, or is in another divot.
        """
        collection = step.collection
        collection.capture(
            PlannedCapture(placement=requested.placement, divot=requested.divot, posture=requested.posture)
        )
        return _message(collection.status)

    @router.delete("/collection/captures/last", responses=rejections(409))
    def discard_last() -> AccuracyTestMessage:
        """Stop the active capture, or discard the last one, which is then due again."""
        collection = step.collection
        collection.discard_last()
        return _message(collection.status)

    @router.post("/collection/conclusion", status_code=201, responses=rejections(409, 422, 503, 507))
    def conclude(requested: CertificateRequest) -> IssuedCertificateMessage:
        """Issue, sign and install the certificate of a complete test without problems, and end the test."""
        head = read_head_of(home.folder)
        issued = step.conclude(
            made_by=requested.made_by,
            valid_days=requested.valid_days,
            audit=None if head is None else CertifiedAudit(lines=head.count, sha256=head.sum),
        )
        return IssuedCertificateMessage(
            marker=issued.tool.marker,
            error_95_mm=issued.error_95_mm,
            valid_until=issued.valid_until.isoformat(),
        )

    return router


def _plate(text: str | None) -> PlateFile:
    return printed_plate() if text is None else plate_file_in(text)


def _message(status: AccuracyStatus) -> AccuracyTestMessage:
    plate, assessment, capture = status.system.plate, status.assessment, status.capture
    return AccuracyTestMessage(
        tool=status.tool,
        marker=status.system.marker,
        plate=plate.name,
        divots=_divots(status),
        planned=len(status.planned),
        taken=len(status.captures),
        due=None if status.due is None else PlannedCaptureMessage(**_names(status.due)),
        last=_taken(status.captures[-1]) if status.captures else None,
        capture=None
        if capture is None
        else DivotCaptureMessage(
            **_names(capture.planned),
            state=capture.state,
            seen=capture.seen,
            images=capture.images,
            problem=problem_message(capture.problem),
        ),
        error_95_mm=None if assessment is None else round_up(assessment.figures.error_95_mm),
        problems=[translated_problem(one) for one in status.problems],
    )


def _divots(status: AccuracyStatus) -> list[DivotMessage]:
    points = status.system.plate.divots
    placement = (status.due or status.planned[-1]).placement
    taken = [one.divot for one in status.captures if one.placement == placement]
    return [
        DivotMessage(name=name, x_mm=points[name][0], y_mm=points[name][1], taken=taken.count(name))
        for name in dict.fromkeys(one.divot for one in status.planned)
    ]


def _names(one: PlannedCapture | DivotCapture) -> dict[str, str]:
    return {"placement": one.placement, "divot": one.divot, "posture": one.posture}


def _taken(one: DivotCapture) -> TakenCaptureMessage:
    return TakenCaptureMessage(
        **_names(one),
        images=one.images,
        jitter_mm=float(one.jitter_covariance_mm2.trace() ** 0.5),
        jitter_deg=one.jitter_deg,
    )
