"""Build the navigation snapshot of one image from the sightings of its markers."""

from collections.abc import Mapping
from math import nan

import numpy as np

from tracker.geometry import Anchor, Array, Camera, Marker, Rigid, chained_covariance
from tracker.navigation.assessment import Assessment, assess
from tracker.navigation.deviation import Deviation, deviation_from_channel
from tracker.navigation.drill_reference import DrillReference, tool_in_vertebra
from tracker.navigation.snapshot import (
    NO_MOTION,
    Absent,
    AbsentReason,
    MotionState,
    NavigationSnapshot,
    Setup,
    ToolPose,
    VertebraPose,
)
from tracker.navigation.uncertainty import DrillAnalysis, UncertainPose
from tracker.pose import (
    Seen,
    Sighting,
    SmoothedPose,
    ToolModel,
    covariance_at_lever,
    is_twice_in_view,
    marker_point_covariance_mm2,
)
from tracker.registration import AnchoredTo, Registration


def locate_tool(
    setup: Setup,
    tool: ToolModel,
    sighting: Sighting,
    steadied: SmoothedPose | None = None,
    motion: MotionState = NO_MOTION,
) -> ToolPose | Absent:
    """Return the pose of the tool in the camera frame, or the reason why it is absent.

    A smoothed pose replaces the measured one, unless its uncertainty at the present tip is too large.
    """
    if not isinstance(sighting, Seen):
        return _unseen(sighting, AbsentReason.MARKER_UNSEEN)
    if not setup.camera_calibrated:
        return Absent(reason=AbsentReason.CAMERA_NOT_CALIBRATED)
    if motion.camera_changes:
        return Absent(reason=AbsentReason.CAMERA_CHANGED)
    if tool.marker in motion.jumped:
        return Absent(reason=AbsentReason.POSE_JUMPED)
    own = _placed(tool, sighting.camera_from_marker, sighting.pose_covariance)
    # This includes an ambiguous planar pose, whose covariance is that of the mixture of both solutions.
    if _tip_sd_mm(own) > setup.max_tip_sd_mm:
        return Absent(reason=AbsentReason.POSE_UNCERTAIN)
    if steadied is None:
        return own
    steady = _placed(tool, steadied.camera_from_marker, steadied.pose_covariance, lag_ms=steadied.lag_ms)
    return own if _tip_sd_mm(steady) > setup.max_tip_sd_mm else steady


def _unseen(sighting: Sighting | None, reason: AbsentReason) -> Absent:
    """Return this reason for a marker that is not seen, or MARKER_TWICE."""
    return Absent(reason=AbsentReason.MARKER_TWICE if is_twice_in_view(sighting) else reason)


def _placed(
    tool: ToolModel, pose: Rigid[Camera, Marker], covariance: Array, *, lag_ms: float = 0.0
) -> ToolPose:
    return ToolPose(
        camera_from_tool=pose @ tool.marker_from_tool,
        tip_covariance_mm2=marker_point_covariance_mm2(
            pose, covariance, tool.marker_from_tool.translation_mm
        ),
        lag_ms=lag_ms,
    )


def _tip_sd_mm(tool: ToolPose) -> float:
    return float(np.sqrt(np.trace(tool.tip_covariance_mm2)))


def locate_vertebra(
    setup: Setup, sightings: Mapping[str, Sighting], motion: MotionState = NO_MOTION
) -> VertebraPose | Absent:
    """Return the pose of the planned vertebra in this image, or the reason why it is absent."""
    registration = setup.registration
    if isinstance(registration, Absent):
        return registration
    if registration.anchored_to is AnchoredTo.CAMERA and motion.camera_moved:
        return Absent(reason=AbsentReason.CAMERA_MOVED)
    if registration.anchored_to is AnchoredTo.REFERENCE and motion.reference_moved:
        return Absent(reason=AbsentReason.REFERENCE_MOVED)
    if registration.anchored_to is AnchoredTo.CAMERA:
        fixed = registration.anchor_from_vertebra
        return VertebraPose(
            camera_from_vertebra=Rigid(rotation=fixed.rotation, translation_mm=fixed.translation_mm),
            covariance=registration.covariance,
            tip_jacobian=registration.tip_jacobian,
            tool=registration.tool,
        )
    seen = sightings.get(setup.reference)
    if not isinstance(seen, Seen):
        return _unseen(seen, AbsentReason.REFERENCE_UNSEEN)
    if not setup.camera_calibrated:
        return Absent(reason=AbsentReason.CAMERA_NOT_CALIBRATED)
    if setup.reference in motion.jumped:
        return Absent(reason=AbsentReason.POSE_JUMPED)
    marker = seen.camera_from_marker
    camera_from_anchor: Rigid[Camera, Anchor] = Rigid(
        rotation=marker.rotation, translation_mm=marker.translation_mm
    )
    return VertebraPose(
        camera_from_vertebra=camera_from_anchor @ registration.anchor_from_vertebra,
        covariance=chained_covariance(
            camera_from_anchor,
            covariance_at_lever(seen.pose_covariance, _lever_mm(setup, registration)),
            registration.anchor_from_vertebra,
            registration.covariance,
        ),
        tip_jacobian=np.vstack(
            [marker.rotation @ registration.tip_jacobian[:3], marker.rotation @ registration.tip_jacobian[3:]]
        ),
        tool=registration.tool,
    )


def _lever_mm(setup: Setup, registration: Registration) -> float:
    """Return the lever at which a tilt of the reference marker displaces the planned entry.

    Not of the origin of the vertebra frame, which is that of the CT and often lies far away. 0 without a
    channel, because nothing is measured then.
    """
    if isinstance(setup.channel, Absent):
        return 0.0
    entry = registration.anchor_from_vertebra.move_points(setup.channel.entry_in_vertebra_mm)
    return float(np.linalg.norm(entry))


def _while_placed(
    setup: Setup, vertebra: VertebraPose | Absent, tool: ToolPose | Absent
) -> ToolPose | Absent:
    """Return the tool; after registration, only while the pose of the vertebra is known.

    A drill drawn over a patient whose pose was lost would look like valid navigation. While that pose awaits
    confirmation by a person, the plan is displayed and the drill is not.
    """
    if isinstance(tool, Absent):
        return tool
    if not isinstance(vertebra, Absent):
        is_stopped = setup.withheld is AbsentReason.NOT_CONFIRMED
        return Absent(reason=AbsentReason.NOT_CONFIRMED) if is_stopped else tool
    return tool if vertebra.reason is AbsentReason.NOT_REGISTERED else vertebra


def tool_deviation(
    setup: Setup, tool: ToolPose | Absent, vertebra: VertebraPose | Absent
) -> Deviation | Absent:
    """Return the tool's deviation from the channel, or the reason why it is absent."""
    if isinstance(tool, Absent):
        return tool
    if isinstance(setup.channel, Absent):
        return setup.channel
    if isinstance(vertebra, Absent):
        return vertebra
    if setup.withheld is not None:
        return Absent(reason=setup.withheld)
    return deviation_from_channel(
        vertebra.camera_from_vertebra.inverse @ tool.camera_from_tool, setup.channel, setup.side
    )


def _analyse(
    setup: Setup,
    drill_reference: DrillReference | None,
    vertebra: VertebraPose | Absent,
    sighting: Sighting,
    name: str,
    steadied: SmoothedPose | None,
) -> DrillAnalysis | Absent:
    """Return the clearance and uncertainty analysis of a tool that has a deviation."""
    if drill_reference is None or isinstance(setup.channel, Absent):
        return Absent(reason=AbsentReason.NO_PLAN)
    if isinstance(vertebra, Absent):
        return vertebra
    if not isinstance(sighting, Seen):
        return Absent(reason=AbsentReason.MARKER_UNSEEN)
    tool = setup.tools[name]
    pose, covariance = sighting.camera_from_marker, sighting.pose_covariance
    # Same choice as in `locate_tool`: a smoothed pose that is too uncertain is not displayed.
    if steadied is not None:
        steady = _placed(tool, steadied.camera_from_marker, steadied.pose_covariance)
        if _tip_sd_mm(steady) <= setup.max_tip_sd_mm:
            pose, covariance = steadied.camera_from_marker, steadied.pose_covariance
    placed = tool_in_vertebra(
        UncertainPose(pose=vertebra.camera_from_vertebra, covariance=vertebra.covariance),
        UncertainPose(pose=pose, covariance=covariance),
        tool,
        tip_jacobian=vertebra.tip_jacobian_for(tool),
    )
    return drill_reference.analyse(placed, tool, setup.channel)


def _assess(
    setup: Setup, name: str, deviation: Deviation | Absent, analysis: DrillAnalysis | Absent
) -> Assessment | Absent:
    """Return the assessment of a tool, or the reason why it is absent."""
    if isinstance(deviation, Absent):
        return deviation
    if isinstance(setup.channel, Absent):
        return setup.channel
    return assess(
        deviation,
        None if isinstance(analysis, Absent) else analysis,
        setup.channel,
        setup.limits,
        min_error_95_mm=setup.min_errors_95_mm.get(name, nan),
    )


def navigate(
    *,
    setup: Setup,
    sightings: Mapping[str, Sighting],
    image_number: int,
    captured_at_s: float,
    size_wh_px: tuple[int, int],
    stage_ms: Mapping[str, float],
    skipped_images: int,
    steadied: Mapping[str, SmoothedPose] | None = None,
    drill_reference: DrillReference | None = None,
    motion: MotionState = NO_MOTION,
) -> NavigationSnapshot:
    """Build the snapshot of one image from the sightings of its markers.

    Where a tool's pose was smoothed (`ToolSmoothing`), all values of the tool derive from the smoothed pose.
    Without a drill reference no clearances are computed.
    """
    steady = steadied or {}
    vertebra = locate_vertebra(setup, sightings, motion)
    tools = {
        name: _while_placed(
            setup, vertebra, locate_tool(setup, tool, sightings[tool.marker], steady.get(name), motion)
        )
        for name, tool in setup.tools.items()
    }
    deviations = {name: tool_deviation(setup, tool, vertebra) for name, tool in tools.items()}
    analyses = {
        name: one
        if isinstance(one, Absent)
        else _analyse(
            setup, drill_reference, vertebra, sightings[setup.tools[name].marker], name, steady.get(name)
        )
        for name, one in deviations.items()
    }
    return NavigationSnapshot(
        image_number=image_number,
        captured_at_s=captured_at_s,
        size_wh_px=size_wh_px,
        setup=setup,
        sightings=sightings,
        vertebra=vertebra,
        tools=tools,
        deviations=deviations,
        analyses=analyses,
        assessments={name: _assess(setup, name, one, analyses[name]) for name, one in deviations.items()},
        motion=motion,
        stage_ms=stage_ms,
        skipped_images=skipped_images,
    )
