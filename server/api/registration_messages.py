"""What is asked and answered about registration."""

from typing import Annotated, TypeAlias

import numpy as np
from pydantic import Field

from server.api.case_messages import HeadingMessage, heading_message
from server.api.doing import MadeBy
from server.config import Name, RegistrationConfig
from server.procedure.registered import KeptCheck, KeptNudge, KeptRegistration, Value
from server.procedure.registration import (
    CheckStatus,
    NudgesStatus,
    PointsStatus,
    ShelvedRegistration,
    TouchState,
    TouchStatus,
    residuals_mm,
    target_errors,
)
from server.stream.messages import Message, ProblemMessage, problem_message
from tracker.plan.remark import Remark
from tracker.registration import AnchoredTo, Method
from tracker.registration.nudge import NudgeAxis, NudgeKind

LandmarkName: TypeAlias = Annotated[str, Field(min_length=1, max_length=60)]
VertebraName: TypeAlias = Annotated[str, Field(min_length=1, max_length=60)]


class ToolRequest(Message):
    """Which tool touches."""

    tool: Name


class PointsRequest(ToolRequest):
    """Which tool touches which vertebra."""

    vertebra: VertebraName | None = None
    """Its name in the plan; the one that is to be drilled if left out."""


class LandmarkRequest(Message):
    """One landmark of the plan."""

    landmark: LandmarkName


class UseRequest(LandmarkRequest):
    """Whether a landmark has a say in the fit."""

    used: bool


class CheckRequest(LandmarkRequest):
    """On which landmark the tip of which tool is held."""

    tool: Name


class ByRequest(Message):
    """Who does it."""

    made_by: MadeBy


class NudgeRequest(Message):
    """One small step by hand."""

    made_by: MadeBy
    kind: NudgeKind
    """shift: along the axis, in mm; turn: about it, in degrees, right-handed."""
    axis: NudgeAxis
    """Of the patient, named for the way that is positive."""
    amount: Annotated[float, Field(ge=-1.0, le=1.0)]
    """0.1, 0.5 or 1, or the same with a minus."""


class NudgesMessage(Message):
    """The nudges that hold."""

    vertebra: str
    version: int
    """Of the registration with them."""
    nudges: list[KeptNudge]
    """The oldest first."""
    shift_mm: float
    """How far all of them lead, between the entry points."""
    turn_deg: float
    max_mm: float
    max_deg: float


class TouchMessage(Message):
    """A capture of the tip on a landmark."""

    landmark: str
    state: TouchState
    images: int
    """In which the tip was seen so far."""
    wanted: int
    rate_hz: float | None
    """Images/s that were tracked so far; null before the second one."""
    left_s: float | None
    """How long the tip is still to be held at this rate; null before the second image."""
    spread_mm: list[float] | None
    """Standard deviation of the tip along the anchor's axes; null until it is taken."""
    problem: ProblemMessage | None
    """Why it was refused."""


class TouchedLandmarkMessage(Message):
    """A landmark, and the tip on it."""

    name: str
    point_lps_mm: list[float]
    touched: bool
    used: bool
    tip_in_anchor_mm: list[float] | None
    spread_mm: list[float] | None
    tip_sd_mm: float | None
    """How sure the tip is (root of the sum of variances)."""
    residual_mm: float | None
    """How far the tip comes to lie from the landmark; null while there is no fit."""
    left_out_mm: float | None
    """The same when all others alone are fitted; null where those are too few."""


class TargetMessage(Message):
    """The error to expect at one point of a channel."""

    side: str
    depth_mm: float
    """From the entry point; 0 is the entry point itself."""
    expected_mm: float
    """3-D RMS by Fitzpatrick's formula."""
    stated_mm: float
    """3-D RMS as stated and gated."""


class RemarkMessage(Message):
    """Something that should be known."""

    code: str
    message: str
    remedy: str


class PointLimitsMessage(Message):
    """What points must reach."""

    min_points: int
    max_spread_mm: float
    """Standard deviation of the tip held on a landmark, along its worst axis."""
    max_fre_mm: float
    max_left_out_mm: float
    max_tre_mm: float
    """Stated error (3-D RMS) at the entry points."""


class PointsMessage(Message):
    """How far registration by points has come."""

    vertebra: str
    tool: str
    anchored_to: AnchoredTo
    landmarks: list[TouchedLandmarkMessage]
    capture: TouchMessage | None
    """The one that runs, or the last one; null before the first."""
    fre_rms_mm: float | None
    targets: list[TargetMessage]
    """Along every channel of the vertebra."""
    limits: PointLimitsMessage
    remarks: list[RemarkMessage]
    missing: list[ProblemMessage]
    """What keeps it from being concluded; empty when it passes its gate."""


class CheckMessage(Message):
    """How far a check on anatomy has come."""

    vertebra: str
    tool: str
    capture: TouchMessage
    max_mm: float
    """How far the tip may be from where the plan has the landmark."""
    max_spread_mm: float
    """Standard deviation of the tip held on it, along its worst axis."""
    outcome: KeptCheck | None
    """What would be kept; null until the tip was captured."""


class RunningMessage(Message):
    """What was begun, and neither kept nor thrown away yet."""

    points: bool
    sweep: bool
    check: bool


class CheckRuleMessage(Message):
    """What a check must reach, and how long it lasts."""

    required: bool
    max_mm: float
    again_after_min: float
    """From then on it is asked for again; navigation goes on."""


class RegistrationMessage(Message):
    """The newest registration of a vertebra."""

    heading: HeadingMessage
    vertebra: str
    method: Method
    anchored_to: AnchoredTo
    reference: str | None
    anchor_from_vertebra: list[list[float]]
    """4 rows of 4: `x_anchor = rotation @ x_lps + translation`."""
    covariance: list[list[float]]
    """6 rows of 6 [mm, rad], translation first."""
    numbers: dict[str, Value]
    made_from: dict[str, object]
    check: CheckRuleMessage


def points_message(
    status: PointsStatus, missing: list[ProblemMessage], gate: RegistrationConfig
) -> PointsMessage:
    """The points so far, as they are told."""
    fit = status.fit
    off = residuals_mm(status)
    left_out = {} if fit is None else {fit.pairs.labels[index]: far for index, far in fit.left_out_mm.items()}
    return PointsMessage(
        vertebra=status.ground.vertebra.name,
        tool=status.ground.tool,
        anchored_to=status.ground.anchored_to,
        landmarks=[
            TouchedLandmarkMessage(
                name=one.name,
                point_lps_mm=one.point_lps_mm.tolist(),
                touched=one.touched is not None,
                used=one.touched is not None and one.used,
                tip_in_anchor_mm=None if one.touched is None else one.touched.tip_in_anchor_mm.tolist(),
                spread_mm=None if one.touched is None else one.touched.spread_mm.tolist(),
                tip_sd_mm=None
                if one.touched is None
                else float(np.sqrt(np.trace(one.touched.covariance_mm2))),
                residual_mm=off.get(one.name),
                left_out_mm=left_out.get(one.name),
            )
            for one in status.landmarks
        ],
        capture=None if status.capture is None else touch_message(status.capture),
        fre_rms_mm=None if fit is None else fit.fre_rms_mm,
        targets=[]
        if fit is None
        else [
            TargetMessage(
                side=error.side,
                depth_mm=error.depth_mm,
                expected_mm=error.expected_mm,
                stated_mm=error.stated_mm,
            )
            for error in target_errors(status.ground, fit)
        ],
        limits=PointLimitsMessage(
            min_points=gate.min_points,
            max_spread_mm=gate.max_capture_sd_mm,
            max_fre_mm=gate.max_fre_mm,
            max_left_out_mm=gate.max_left_out_mm,
            max_tre_mm=gate.max_tre_mm,
        ),
        remarks=[] if fit is None else [remark_message(remark) for remark in fit.remarks],
        missing=missing,
    )


def remark_message(remark: Remark) -> RemarkMessage:
    """A remark, as it is told."""
    return RemarkMessage(code=remark.code, message=remark.message, remedy=remark.remedy)


def touch_message(status: TouchStatus) -> TouchMessage:
    """A capture, as it is told."""
    return TouchMessage(
        landmark=status.landmark,
        state=status.state,
        images=status.images,
        wanted=status.wanted,
        rate_hz=status.rate_hz,
        left_s=status.left_s,
        spread_mm=None if status.touched is None else status.touched.spread_mm.tolist(),
        problem=problem_message(status.problem),
    )


def check_message(status: CheckStatus) -> CheckMessage:
    """A check, as it is told."""
    return CheckMessage(
        vertebra=status.vertebra,
        tool=status.tool,
        capture=touch_message(status.capture),
        max_mm=status.max_mm,
        max_spread_mm=status.max_spread_mm,
        outcome=status.outcome,
    )


def nudges_message(status: NudgesStatus) -> NudgesMessage:
    """The nudges, as they are told."""
    return NudgesMessage(
        vertebra=status.shelved.kept.vertebra,
        version=status.shelved.document.version,
        nudges=list(status.nudges),
        shift_mm=status.shift_mm,
        turn_deg=status.turn_deg,
        max_mm=status.limits.max_mm,
        max_deg=status.limits.max_deg,
    )


def registration_message(shelved: ShelvedRegistration, gate: RegistrationConfig) -> RegistrationMessage:
    """A registration, as it is told."""
    kept: KeptRegistration = shelved.kept
    return RegistrationMessage(
        heading=heading_message(shelved.document, shelved.standing),
        vertebra=kept.vertebra,
        method=kept.method,
        anchored_to=kept.anchored_to,
        reference=kept.reference or None,
        anchor_from_vertebra=[list(row) for row in kept.anchor_from_vertebra],
        covariance=[list(row) for row in kept.covariance],
        numbers=dict(kept.numbers),
        made_from=dict(kept.made_from),
        check=CheckRuleMessage(
            required=gate.check_required,
            max_mm=gate.max_check_mm,
            again_after_min=gate.check_again_after_min,
        ),
    )
