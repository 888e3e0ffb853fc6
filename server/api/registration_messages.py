"""Messages about registration."""

from typing import Annotated, TypeAlias

import numpy as np
from pydantic import Field

from server.api.case_messages import HeadingMessage, heading_message
from server.api.remark_messages import RemarkMessage, remark_message
from server.api.requester import MadeBy
from server.config import Name, RegistrationConfig
from server.procedure.registration import (
    CaptureState,
    CaptureStatus,
    CheckStatus,
    NudgeStatus,
    PointsStatus,
    StoredRegistration,
    residuals_mm,
    target_errors,
)
from server.procedure.registration_record import CheckRecord, NudgeRecord, RegistrationRecord, Value
from server.stream.messages import Message, ProblemMessage, problem_message
from tracker.registration import AnchoredTo, Method
from tracker.registration.nudge import NudgeAxis, NudgeKind

LandmarkName: TypeAlias = Annotated[str, Field(min_length=1, max_length=60)]
VertebraName: TypeAlias = Annotated[str, Field(min_length=1, max_length=60)]


class ToolRequest(Message):
    """The tool to capture with."""

    tool: Name


class PointsRequest(ToolRequest):
    """The tool and the vertebra to register."""

    vertebra: VertebraName | None = None
    """Name in the plan; default: the vertebra of the active channel."""


class LandmarkRequest(Message):
    """One landmark of the plan."""

    landmark: LandmarkName


class UseRequest(LandmarkRequest):
    """Whether a landmark is used in the fit."""

    used: bool


class CheckRequest(LandmarkRequest):
    """Landmark and tool of a check."""

    tool: Name


class ByRequest(Message):
    """The person who acts."""

    made_by: MadeBy


class NudgeRequest(Message):
    """One manual correction step."""

    made_by: MadeBy
    kind: NudgeKind
    """shift: along the axis in mm; turn: rotation about it in degrees, right-handed."""
    axis: NudgeAxis
    """Patient axis, named after its positive direction."""
    amount: Annotated[float, Field(ge=-1.0, le=1.0)]
    """0.1, 0.5 or 1, positive or negative."""


class NudgesMessage(Message):
    """The manual corrections in use."""

    vertebra: str
    version: int
    """Version of the registration that includes them."""
    nudges: list[NudgeRecord]
    """Oldest first."""
    shift_mm: float
    """Total shift, measured between the entry points."""
    rotation_deg: float
    max_mm: float
    max_deg: float


class CaptureMessage(Message):
    """A capture of the tip on a landmark."""

    landmark: str
    state: CaptureState
    images: int
    """Images with the tip so far."""
    wanted: int
    rate_hz: float | None
    """Tracked images per second; null before the second image."""
    left_s: float | None
    """Remaining time at this rate; null before the second image."""
    spread_mm: list[float] | None
    """Standard deviation of the tip along the anchor axes; null until captured."""
    problem: ProblemMessage | None
    """Why it was rejected."""


class TouchedLandmarkMessage(Message):
    """A landmark with its captured tip position."""

    name: str
    point_lps_mm: list[float]
    touched: bool
    used: bool
    tip_in_anchor_mm: list[float] | None
    spread_mm: list[float] | None
    tip_sd_mm: float | None
    """Standard deviation of the tip (root of the sum of variances)."""
    residual_mm: float | None
    """Residual after the fit; null without a fit."""
    leave_one_out_mm: float | None
    """Leave-one-out residual; null if the other points are too few."""


class TargetMessage(Message):
    """Target registration error (TRE) at one point of a channel."""

    side: str
    depth_mm: float
    """Depth from the entry point."""
    expected_mm: float
    """Expected TRE (3-D RMS, Fitzpatrick 1998)."""
    stated_mm: float
    """Stated TRE (3-D RMS), compared with the limit."""


class PointLimitsMessage(Message):
    """Limits of a registration by landmarks."""

    min_points: int
    max_spread_mm: float
    """Standard deviation of the tip on a landmark, along its worst axis."""
    max_fre_mm: float
    max_left_out_mm: float
    max_tre_mm: float
    """Stated TRE (3-D RMS) at the entry points."""


class PointsMessage(Message):
    """Progress of a registration by landmarks."""

    vertebra: str
    tool: str
    anchored_to: AnchoredTo
    landmarks: list[TouchedLandmarkMessage]
    capture: CaptureMessage | None
    """The present or last capture; null before the first."""
    fre_rms_mm: float | None
    targets: list[TargetMessage]
    """TRE along every channel of the vertebra."""
    limits: PointLimitsMessage
    remarks: list[RemarkMessage]
    missing: list[ProblemMessage]
    """Unmet requirements; empty if it passes its limits."""


class CheckMessage(Message):
    """Progress of a check on anatomy."""

    vertebra: str
    tool: str
    capture: CaptureMessage
    max_mm: float
    """Maximum distance of the tip from the planned landmark."""
    max_spread_mm: float
    """Standard deviation of the tip, along its worst axis."""
    outcome: CheckRecord | None
    """Result to be stored; null until the tip was captured."""


class RunningMessage(Message):
    """Registrations and checks in progress."""

    points: bool
    sweep: bool
    check: bool


class CheckRuleMessage(Message):
    """Limit of a check and its period of validity."""

    required: bool
    max_mm: float
    again_after_min: float
    """The check is due again after this time; navigation continues."""


class RegistrationMessage(Message):
    """The newest registration of a vertebra."""

    heading: HeadingMessage
    vertebra: str
    method: Method
    anchored_to: AnchoredTo
    reference: str | None
    anchor_from_vertebra: list[list[float]]
    """4x4 matrix: `x_anchor = rotation @ x_lps + translation`."""
    covariance: list[list[float]]
    """6x6 matrix [mm, rad], translation first."""
    numbers: dict[str, Value]
    made_from: dict[str, object]
    check: CheckRuleMessage


def points_message(
    status: PointsStatus, missing: list[ProblemMessage], gate: RegistrationConfig
) -> PointsMessage:
    """Return the message of a registration by landmarks."""
    fit = status.fit
    off = residuals_mm(status)
    left_out = (
        {} if fit is None else {fit.pairs.labels[index]: far for index, far in fit.leave_one_out_mm.items()}
    )
    return PointsMessage(
        vertebra=status.context.vertebra.name,
        tool=status.context.tool,
        anchored_to=status.context.anchored_to,
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
                leave_one_out_mm=left_out.get(one.name),
            )
            for one in status.landmarks
        ],
        capture=None if status.capture is None else capture_message(status.capture),
        fre_rms_mm=None if fit is None else fit.fre_rms_mm,
        targets=[]
        if fit is None
        else [
            TargetMessage.model_validate(error, from_attributes=True)
            for error in target_errors(status.context, fit)
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


def capture_message(status: CaptureStatus) -> CaptureMessage:
    """Return the message of a capture."""
    return CaptureMessage(
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
    """Return the message of a check."""
    return CheckMessage(
        vertebra=status.vertebra,
        tool=status.tool,
        capture=capture_message(status.capture),
        max_mm=status.max_mm,
        max_spread_mm=status.max_spread_mm,
        outcome=status.outcome,
    )


def nudges_message(status: NudgeStatus) -> NudgesMessage:
    """Return the message of the manual corrections."""
    return NudgesMessage(
        vertebra=status.stored.record.vertebra,
        version=status.stored.document.version,
        nudges=list(status.nudges),
        shift_mm=status.shift_mm,
        rotation_deg=status.rotation_deg,
        max_mm=status.limits.max_mm,
        max_deg=status.limits.max_deg,
    )


def registration_message(stored: StoredRegistration, gate: RegistrationConfig) -> RegistrationMessage:
    """Return the message of a registration."""
    record: RegistrationRecord = stored.record
    return RegistrationMessage(
        heading=heading_message(stored.document, stored.validity),
        vertebra=record.vertebra,
        method=record.method,
        anchored_to=record.anchored_to,
        reference=record.reference or None,
        anchor_from_vertebra=[list(row) for row in record.anchor_from_vertebra],
        covariance=[list(row) for row in record.covariance],
        numbers=dict(record.numbers),
        made_from=dict(record.made_from),
        check=CheckRuleMessage(
            required=gate.check_required,
            max_mm=gate.max_check_mm,
            again_after_min=gate.check_again_after_min,
        ),
    )
