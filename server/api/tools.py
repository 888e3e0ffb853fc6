"""Tool calibration: collect poses, then store tip or axis."""

from typing import Annotated

from fastapi import APIRouter, Response
from pydantic import Field

from server.api.case_messages import DocumentMessage, document_message
from server.api.errors import rejections
from server.api.requester import MadeBy
from server.config import Name, Point
from server.live import Problem
from server.procedure.tool import KnownTool, ToolStep
from server.procedure.tool_collection import ToolCollectionStatus
from server.store import Current
from server.stream.messages import Message, ProblemMessage, problem_message
from tracker.errors import CalibrationError
from tracker.pose.tool import PivotCalibration, SpinCalibration, TipCheck
from tracker.pose.tool.collector import Missing, Need, Outcome, Purpose, Taking


class PoseCollectionRequest(Message):
    """Tool and purpose of a pose collection."""

    tool: Name
    purpose: Purpose
    marker: Name | None = None
    """Its marker; optional if known from case or settings, or if there is only one."""


class KnownToolMessage(Message):
    """A tool of the settings or of the open case."""

    name: str
    from_settings: bool
    """Whether the settings define it; the case has precedence."""
    marker: str | None
    radius_mm: float | None
    length_mm: float | None
    calibration: DocumentMessage | None
    """Its newest calibration in the open case, valid or not."""
    check: DocumentMessage | None
    """Its newest tip check."""


class KnownToolsMessage(Message):
    """All tools, by name."""

    collecting: bool
    """Whether poses are being collected: see `/api/tools/collection`."""
    tools: list[KnownToolMessage]


class MissingMessage(Message):
    """An unmet requirement."""

    need: Need
    there: float
    """Poses or degrees."""
    wanted: float


class OutcomeMessage(Message):
    """Result of the poses so far."""

    rms_3d_mm: float | None
    """3-D RMS of the tip about the pivot; null for a spin."""
    tip_in_marker_mm: list[float] | None
    tip_sd_mm: float | None
    axis_in_marker: list[float] | None
    axis_sd_deg: float | None
    wobble_deg: float | None
    max_mm: float | None
    """Maximum distance of the tip from the pivot, in a check."""


class PoseCollectionMessage(Message):
    """Progress of a pose collection."""

    tool: str
    marker: str
    purpose: Purpose
    running: bool
    taken: int
    rejected_images: dict[Taking, int]
    """Number of skipped images by reason."""
    newest: Taking
    """Result for the newest image."""
    tilt_range_deg: float | None
    """Tilt range in the direction of the largest tilt; null if unknown."""
    tilt_range_across_deg: float | None
    """Tilt range perpendicular to it."""
    spin_range_deg: float | None
    outcome: OutcomeMessage | None
    outcome_problem: ProblemMessage | None
    """Why there is no result yet."""
    missing: list[MissingMessage]
    """Empty if the poses suffice."""
    problem: ProblemMessage | None


class ConclusionRequest(Message):
    """Store the result; omitted values are unchanged or come from the settings."""

    made_by: MadeBy
    radius_mm: Annotated[float, Field(gt=0.0, le=50.0)] | None = None
    length_mm: Annotated[float, Field(gt=0.0, le=1000.0)] | None = None
    axis_in_marker: Point | None = None


def tools_router(step: ToolStep) -> APIRouter:
    """Return the router of `/api/tools`."""
    router = APIRouter(prefix="/api/tools", tags=["tools"])

    @router.get("", responses=rejections(503))
    def tools() -> KnownToolsMessage:
        """Return the known tools with their newest calibrations."""
        return KnownToolsMessage(
            collecting=step.is_collecting, tools=[_known(one, step) for one in step.all()]
        )

    @router.post("/collection", status_code=201, responses=rejections(409, 422, 503))
    def begin(requested: PoseCollectionRequest) -> PoseCollectionMessage:
        """Start collecting poses of a tool from the live images, for pivot, spin or tip check.

        Poses collected before are discarded.
        """
        return _message(step.begin(requested.tool, marker=requested.marker, purpose=requested.purpose).status)

    @router.get("/collection", responses=rejections(409))
    def progress() -> PoseCollectionMessage:
        """Return the progress, the present result, and what is missing."""
        return _message(step.collection.status)

    @router.delete("/collection", status_code=204)
    def end() -> Response:
        """Stop and discard the poses."""
        step.end()
        return Response(status_code=204)

    @router.post("/collection/conclusion", status_code=201, responses=rejections(409, 422, 503, 507))
    def conclude(requested: ConclusionRequest) -> DocumentMessage:
        """Store the result in the open case if it passes its limits; it is used from then on."""
        document = step.conclude(
            made_by=requested.made_by,
            radius_mm=requested.radius_mm,
            length_mm=requested.length_mm,
            axis_in_marker=requested.axis_in_marker,
        )
        return document_message(document, Current())

    return router


def _known(tool: KnownTool, step: ToolStep) -> KnownToolMessage:
    configured, document = tool.configured, tool.document
    return KnownToolMessage(
        name=tool.name,
        from_settings=configured is not None,
        marker=None if configured is None else configured.marker,
        radius_mm=None if configured is None else configured.radius_mm,
        length_mm=None if configured is None else configured.length_mm,
        calibration=None if document is None else document_message(document, step.validity(document)),
        check=None if tool.check is None else document_message(tool.check, step.validity(tool.check)),
    )


def _message(status: ToolCollectionStatus) -> PoseCollectionMessage:
    progress = status.progress
    turning = None if isinstance(progress.motion_range, CalibrationError) else progress.motion_range
    outcome = progress.outcome
    return PoseCollectionMessage(
        tool=status.tool,
        marker=status.marker,
        purpose=status.purpose,
        running=status.running,
        taken=progress.taken,
        rejected_images=dict(progress.rejected_images),
        newest=status.newest,
        tilt_range_deg=None if turning is None else turning.tilt_range_deg,
        tilt_range_across_deg=None if turning is None else turning.tilt_range_across_deg,
        spin_range_deg=None if turning is None else turning.spin_range_deg,
        outcome=None if isinstance(outcome, CalibrationError) else _outcome(outcome),
        outcome_problem=problem_message(
            Problem.from_error(outcome) if isinstance(outcome, CalibrationError) else None
        ),
        missing=[_missing(one) for one in progress.missing],
        problem=problem_message(status.problem),
    )


def _missing(one: Missing) -> MissingMessage:
    return MissingMessage(need=one.need, there=one.there, wanted=one.wanted)


def _outcome(outcome: Outcome) -> OutcomeMessage:
    pivot = outcome if isinstance(outcome, PivotCalibration) else None
    spin = outcome if isinstance(outcome, SpinCalibration) else None
    check = outcome if isinstance(outcome, TipCheck) else None
    return OutcomeMessage(
        rms_3d_mm=None if isinstance(outcome, SpinCalibration) else outcome.rms_3d_mm,
        tip_in_marker_mm=None if pivot is None else pivot.tip_in_marker_mm.tolist(),
        tip_sd_mm=None if pivot is None else pivot.tip_sd_mm,
        axis_in_marker=None if spin is None else spin.axis_in_marker.tolist(),
        axis_sd_deg=None if spin is None else spin.axis_sd_deg,
        wobble_deg=None if spin is None else spin.wobble_deg,
        max_mm=None if check is None else check.max_mm,
    )
