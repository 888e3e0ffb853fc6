"""Calibrating tools: poses gathered while somebody tilts or turns one, then its tip or axis kept."""

from typing import Annotated

from fastapi import APIRouter, Response
from pydantic import Field

from server.api.case_messages import DocumentMessage, document_message
from server.api.doing import MadeBy
from server.api.errors import rejections
from server.config import Name, Point
from server.live import Problem
from server.procedure.tool import KnownTool, ToolStep
from server.procedure.tool_collection import GatheringStatus
from server.store import Current
from server.stream.messages import Message, ProblemMessage, problem_message
from tracker.errors import CalibrationError
from tracker.pose.tool import PivotCalibration, SpinCalibration, TipCheck
from tracker.pose.tool.collector import Missing, Need, Outcome, Purpose, Taking


class GatheringRequest(Message):
    """Which tool, and what for."""

    tool: Name
    purpose: Purpose
    marker: Name | None = None
    """That it carries; left out where the case or the settings know it, or where there is but one."""


class KnownToolMessage(Message):
    """A tool that the settings describe or that the open case keeps."""

    name: str
    of_settings: bool
    """Whether the settings describe it; what the case keeps counts before them."""
    marker: str | None
    radius_mm: float | None
    length_mm: float | None
    kept: DocumentMessage | None
    """Its newest calibration in the open case, whether or not it holds."""
    check: DocumentMessage | None
    """The newest check of its tip."""


class KnownToolsMessage(Message):
    """All tools, by name."""

    collecting: bool
    """Whether poses of one are gathered: see `/api/tools/collection`."""
    tools: list[KnownToolMessage]


class MissingMessage(Message):
    """One thing that is missing."""

    need: Need
    there: float
    """Poses or degrees."""
    wanted: float


class OutcomeMessage(Message):
    """What the poses give now."""

    rms_3d_mm: float | None
    """3-D RMS of the tip about the pivot; null for a spin."""
    tip_in_marker_mm: list[float] | None
    tip_sd_mm: float | None
    axis_in_marker: list[float] | None
    axis_sd_deg: float | None
    wobble_deg: float | None
    max_mm: float | None
    """The largest distance of the tip from the pivot, in a check."""


class GatheringMessage(Message):
    """How far gathering poses has come."""

    tool: str
    marker: str
    purpose: Purpose
    running: bool
    taken: int
    passed_over: dict[Taking, int]
    """How many images were not taken, by reason."""
    newest: Taking
    """What became of the newest image."""
    tilt_range_deg: float | None
    """From end to end, in the way in which it was tilted most; null while that is not known."""
    tilt_range_across_deg: float | None
    """At right angles to it."""
    spin_range_deg: float | None
    outcome: OutcomeMessage | None
    outcome_problem: ProblemMessage | None
    """Why the poses give nothing yet."""
    missing: list[MissingMessage]
    """Empty when it is enough."""
    problem: ProblemMessage | None


class ConclusionRequest(Message):
    """Keep the result; what is left out stays as it was, or comes from the settings."""

    made_by: MadeBy
    radius_mm: Annotated[float, Field(gt=0.0, le=50.0)] | None = None
    length_mm: Annotated[float, Field(gt=0.0, le=1000.0)] | None = None
    axis_in_marker: Point | None = None


def tools_router(step: ToolStep) -> APIRouter:
    """Everything under `/api/tools`."""
    router = APIRouter(prefix="/api/tools", tags=["tools"])

    @router.get("", responses=rejections(503))
    def tools() -> KnownToolsMessage:
        """The tools that are known, with their newest calibrations."""
        return KnownToolsMessage(
            collecting=step.is_collecting, tools=[_known(one, step) for one in step.all()]
        )

    @router.post("/collection", status_code=201, responses=rejections(409, 422, 503))
    def begin(asked: GatheringRequest) -> GatheringMessage:
        """Gather poses of a tool from the live images: to pivot it, to spin it, or to check its tip.

        What was gathered before is thrown away.
        """
        return _message(step.begin(asked.tool, marker=asked.marker, purpose=asked.purpose).status)

    @router.get("/collection", responses=rejections(409))
    def progress() -> GatheringMessage:
        """How far it has come, what the poses give now, and what is missing."""
        return _message(step.collection.status)

    @router.delete("/collection", status_code=204)
    def end() -> Response:
        """Gather no more; what was gathered is thrown away."""
        step.end()
        return Response(status_code=204)

    @router.post("/collection/conclusion", status_code=201, responses=rejections(409, 422, 503, 507))
    def conclude(asked: ConclusionRequest) -> DocumentMessage:
        """Keep what the poses give in the open case, if it passes its gate; it is used from then on."""
        document = step.conclude(
            made_by=asked.made_by,
            radius_mm=asked.radius_mm,
            length_mm=asked.length_mm,
            axis_in_marker=asked.axis_in_marker,
        )
        return document_message(document, Current())

    return router


def _known(tool: KnownTool, step: ToolStep) -> KnownToolMessage:
    settled, document = tool.settled, tool.document
    return KnownToolMessage(
        name=tool.name,
        of_settings=settled is not None,
        marker=None if settled is None else settled.marker,
        radius_mm=None if settled is None else settled.radius_mm,
        length_mm=None if settled is None else settled.length_mm,
        kept=None if document is None else document_message(document, step.standing(document)),
        check=None if tool.check is None else document_message(tool.check, step.standing(tool.check)),
    )


def _message(status: GatheringStatus) -> GatheringMessage:
    progress = status.progress
    turning = None if isinstance(progress.turning, CalibrationError) else progress.turning
    outcome = progress.outcome
    return GatheringMessage(
        tool=status.tool,
        marker=status.marker,
        purpose=status.purpose,
        running=status.running,
        taken=progress.taken,
        passed_over=dict(progress.passed_over),
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
