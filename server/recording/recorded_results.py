"""Records of the results of an image, reconstructed from messages and setup of a recording for drawing.

A message contains less than its snapshot: covariances of poses and standard deviations of clearances are NaN
here, and stage times are missing. The overlay needs none of them.
"""

from datetime import datetime
from math import inf, nan
from typing import Any

import numpy as np

from server.loop.tracking_state import TrackingState
from server.recording_file import CodecError, decoded_value, decompressed_json
from server.setup import Preparation
from server.stream.alarm_messages import AlarmMessage, AlarmsMessage, MeasureMessage, SiteMessage
from server.stream.assessment_messages import AssessmentMessage, FigureMessage
from server.stream.judgement_messages import (
    DeviationMessage,
    JudgementMessage,
    NotEnteredMessage,
    SpreadMessage,
    WallProximityMessage,
)
from server.stream.pose_messages import AbsentMessage, MarkerSeenMessage, MarkerUnseenMessage, PoseMessage
from server.stream.snapshot_messages import SnapshotMessage, channel_message
from tracker.errors import CalibrationError
from tracker.geometry import Array, Rigid
from tracker.navigation import (
    Absent,
    Assessment,
    Correction,
    Deviation,
    Figure,
    FigureName,
    NavigationSnapshot,
    Setup,
    ToolPose,
    VertebraPose,
)
from tracker.navigation.alarms import Alarm, AlarmSnapshot, Measure, Peak, Site
from tracker.navigation.clearance import DrillClearance, NearestWall, NotEntered, WallProximity
from tracker.navigation.uncertainty import (
    ELLIPSOID_95,
    DrillAnalysis,
    DrillUncertainty,
    Probability,
    ToleranceCheck,
)
from tracker.pose import Seen, Sighting, Unseen


def state_of(content: bytes) -> TrackingState | None:
    """Return the tracking state of a message; None if another version recorded it, or it is damaged."""
    try:
        state = decoded_value(decompressed_json(content))
    except (CodecError, ValueError):
        return None
    return state if isinstance(state, TrackingState) else None


def setup_of(preparation: Preparation, size_wh_px: tuple[int, int]) -> Setup:
    """Return the setup that tracking used for images of this size."""
    try:
        return preparation.setup_for(size_wh_px)
    except CalibrationError:
        # As in tracking, which measures nothing without a calibration for this size.
        return preparation.uncalibrated_setup_for(size_wh_px)


def belongs_to(setup: Setup, message: SnapshotMessage) -> bool:
    """Return whether the results were computed with this setup, as far as their message states it."""
    registration = setup.registration
    return (
        setup.camera.size_wh_px == (message.width_px, message.height_px)
        and setup.camera_calibrated == message.camera_calibrated
        and (setup.reference or None) == message.reference
        and channel_message(setup) == message.channel
        and (None if isinstance(registration, Absent) else registration.method) == message.registered_by
        and {name: tool.marker for name, tool in setup.tools.items()}
        == {tool.name: tool.marker for tool in message.tools}
    )


def snapshot_of(message: SnapshotMessage, setup: Setup) -> NavigationSnapshot:
    """Return the snapshot of a message.

    Args:
        message: Results of an image.
        setup: Setup with which they were computed, see `belongs_to`.
    """
    vertebra = message.vertebra
    return NavigationSnapshot(
        image_number=message.image_number,
        captured_at_s=message.captured_at_s,
        size_wh_px=(message.width_px, message.height_px),
        setup=setup,
        sightings={one.name: _sighting(one.sighting) for one in message.markers},
        vertebra=Absent(reason=vertebra.reason)
        if isinstance(vertebra, AbsentMessage)
        else VertebraPose(
            camera_from_vertebra=_rigid(vertebra.camera_from_vertebra),
            covariance=np.array(vertebra.covariance),
        ),
        tools={
            tool.name: Absent(reason=tool.pose.reason)
            if isinstance(tool.pose, AbsentMessage)
            else ToolPose(
                camera_from_tool=_rigid(tool.pose.camera_from_tool),
                tip_covariance_mm2=_unknown(3, 3),
                lag_ms=tool.pose.lag_ms,
            )
            for tool in message.tools
        },
        deviations={tool.name: _deviation(tool.deviation) for tool in message.tools},
        analyses={tool.name: _analysis(tool.judgement) for tool in message.tools},
        assessments={tool.name: _assessment(tool.assessment) for tool in message.tools},
        stage_ms={},
        skipped_images=message.skipped_images,
    )


def snapshot_in_state(message: SnapshotMessage, state: TrackingState | None) -> NavigationSnapshot | None:
    """Return the snapshot of a message; None if this state does not have the setup of its results."""
    if state is None:
        return None
    setup = setup_of(state.preparation, (message.width_px, message.height_px))
    return snapshot_of(message, setup) if belongs_to(setup, message) else None


def alarms_of(message: AlarmsMessage) -> AlarmSnapshot:
    """Return the alarms of a message; their times are Unix times."""
    return AlarmSnapshot(
        alarms=tuple(_alarm(one) for one in message.alarms),
        sound=message.sound,
        sound_number=message.sound_number,
        revision=message.revision,
    )


def _rigid(pose: PoseMessage) -> Rigid[Any, Any]:
    return Rigid(rotation=np.array(pose.rotation), translation_mm=np.array(pose.translation_mm))


def _unknown(*shape: int) -> Array:
    return np.full(shape, nan)


def _sighting(message: MarkerSeenMessage | MarkerUnseenMessage) -> Sighting:
    if isinstance(message, MarkerUnseenMessage):
        return Unseen(reason=message.reason, best_score_ratio=message.best_score_ratio)
    pose = message.camera_from_marker
    return Seen(
        # There is no pose without a calibrated camera; nothing is drawn from this one.
        camera_from_marker=Rigid.identity() if pose is None else _rigid(pose),
        pose_covariance=_unknown(6, 6),
        corners_px=np.array(message.corners_px).reshape(-1, 2),
        score_ratio=_or_nan(message.score_ratio),
        target_score_ratio=_or_nan(message.target_score_ratio),
        model_coverage_ratio=_or_nan(message.model_coverage_ratio),
        target_coverage_ratio=_or_nan(message.target_coverage_ratio),
        fit_error_px2=_or_nan(message.fit_error_px2),
        found_by=message.found_by,
    )


def _deviation(message: DeviationMessage | AbsentMessage) -> Deviation | Absent:
    if isinstance(message, AbsentMessage):
        return Absent(reason=message.reason)
    # null for a drill across the channel.
    values = {name: inf if value is None else value for name, value in message if name != "kind"}
    return Deviation(**values)


def _analysis(message: JudgementMessage | AbsentMessage) -> DrillAnalysis | Absent:
    if isinstance(message, AbsentMessage):
        return Absent(reason=message.reason)
    clearance, certain, probability = message.clearance, message.certain, message.probability
    return DrillAnalysis(
        clearance=DrillClearance(
            against=clearance.against,
            now=_wall(clearance.now),
            lookahead=_wall(clearance.lookahead),
            at_end=_wall(clearance.at_end),
            channel=_wall(clearance.channel),
            past_planned_mm=clearance.past_planned_mm,
        ),
        spread=_spread(message.spread),
        certain=ToleranceCheck(
            enough=certain.enough,
            entry_95_mm=_or_infinite(certain.entry_95_mm),
            isthmus_95_mm=_or_infinite(certain.isthmus_95_mm),
            tolerance_mm=certain.tolerance_mm,
            tolerance_deg=certain.tolerance_deg,
        ),
        now=Probability(through_ratio=probability.now_ratio, grade_ratio={}, sd_mm=nan),
        lookahead=Probability(through_ratio=probability.lookahead_ratio, grade_ratio={}, sd_mm=nan),
        at_end=Probability(
            through_ratio=probability.at_end_ratio,
            grade_ratio=dict(probability.at_end_grade_ratio),
            sd_mm=nan,
        ),
        past_planned_ratio=probability.past_planned_ratio,
    )


def _wall(message: WallProximityMessage) -> WallProximity:
    if isinstance(message, NotEnteredMessage):
        return NotEntered()
    return NearestWall(
        clearance_mm=message.clearance_mm,
        point_in_vertebra_mm=np.array(message.point_in_vertebra_mm),
        wall=message.wall,
    )


def _spread(message: SpreadMessage) -> DrillUncertainty:
    half_axes = np.array(message.tip_ellipsoid_mm)
    return DrillUncertainty(
        tip_covariance_mm2=half_axes.T @ half_axes / ELLIPSOID_95**2,
        tip_ellipsoid_mm=half_axes,
        cone_95_deg=message.cone_95_deg,
        tip_sd_mm=message.tip_sd_mm,
        sd_angle_deg=message.sd_angle_deg,
        sd_depth_mm=message.sd_depth_mm,
        sd_at_entry_mm=_or_infinite(message.sd_at_entry_mm),
    )


def _assessment(message: AssessmentMessage | AbsentMessage) -> Assessment | Absent:
    if isinstance(message, AbsentMessage):
        return Absent(reason=message.reason)
    return Assessment(
        verdict=message.verdict,
        figures={name: _figure(getattr(message.figures, name.value)) for name in FigureName},
        corrections=tuple(
            Correction(amount=_or_nan(one.amount), towards=one.towards) for one in message.corrections
        ),
        wall=message.wall,
        end_wall=message.end_wall,
        against=message.against,
    )


def _figure(message: FigureMessage) -> Figure:
    return Figure(
        value=_or_nan(message.value),
        limit=_or_nan(message.limit),
        error_95=_or_nan(message.error_95),
        status=message.status,
    )


def _alarm(message: AlarmMessage) -> Alarm:
    return Alarm(
        number=message.number,
        condition=message.condition,
        state=message.state,
        raised_at_s=_unix_s(message.raised_at),
        presence=message.presence,
        measure=_measure(message.measure),
        site=_site(message.site),
        peak=_peak(message.worst, message.worst_at, message.worst_site),
        earlier_peak=_peak(message.earlier_worst, message.earlier_worst_at, None),
        acknowledged_by=message.acknowledged_by,
        by=message.by,
    )


def _measure(message: MeasureMessage | None) -> Measure | None:
    return None if message is None else Measure(value=message.value, limit=message.limit, unit=message.unit)


def _site(message: SiteMessage | None) -> Site | None:
    if message is None:
        return None
    return Site(
        depth_mm=message.depth_mm, wall=message.wall, against=message.against, tool=message.tool or ""
    )


def _peak(measure: MeasureMessage | None, at: str | None, site: SiteMessage | None) -> Peak | None:
    known = _measure(measure)
    if known is None or at is None:
        return None
    return Peak(measure=known, severity=nan, at_s=_unix_s(at), site=_site(site))


def _unix_s(text: str) -> float:
    return datetime.fromisoformat(text).timestamp()


def _or_nan(value: float | None) -> float:
    return nan if value is None else value


def _or_infinite(value: float | None) -> float:
    return inf if value is None else value
