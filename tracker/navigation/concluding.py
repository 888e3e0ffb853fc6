"""From what was seen in an image to its snapshot."""

from collections.abc import Mapping

import numpy as np

from tracker.geometry import Anchor, Array, Camera, Marker, Rigid, chained_covariance, point_covariance_mm2
from tracker.navigation.assessment import Assessment, assess
from tracker.navigation.certainty import Judged, Placed
from tracker.navigation.deviation import Deviation, deviation_from_channel
from tracker.navigation.guide import Guide, placed_tool
from tracker.navigation.snapshot import (
    UNWATCHED,
    Absent,
    AbsentReason,
    NavigationSnapshot,
    PlacedVertebra,
    Setup,
    ToolInView,
    Watched,
)
from tracker.pose import Seen, Sighting, SteadyPose, ToolModel
from tracker.registration import AnchoredTo


def tool_in_view(
    setup: Setup,
    tool: ToolModel,
    sighting: Sighting,
    steadied: SteadyPose | None = None,
    watched: Watched = UNWATCHED,
) -> ToolInView | Absent:
    """Where the tool is in the camera's frame, or why that is not known.

    A steadied pose takes the place of the image's own, unless it is too unsure of where the tip is now.
    """
    if not isinstance(sighting, Seen):
        return Absent(reason=AbsentReason.MARKER_UNSEEN)
    if not setup.camera_calibrated:
        return Absent(reason=AbsentReason.CAMERA_NOT_CALIBRATED)
    if watched.camera_changes:
        return Absent(reason=AbsentReason.CAMERA_CHANGED)
    if tool.marker in watched.jumped:
        return Absent(reason=AbsentReason.POSE_JUMPED)
    own = _placed(tool, sighting.camera_from_marker, sighting.pose_covariance)
    # Also where two poses explain the image: the covariance then spans both.
    if _tip_sd_mm(own) > setup.max_tip_sd_mm:
        return Absent(reason=AbsentReason.POSE_UNCERTAIN)
    if steadied is None:
        return own
    steady = _placed(tool, steadied.camera_from_marker, steadied.pose_covariance, lag_ms=steadied.lag_ms)
    return own if _tip_sd_mm(steady) > setup.max_tip_sd_mm else steady


def _placed(
    tool: ToolModel, pose: Rigid[Camera, Marker], covariance: Array, *, lag_ms: float = 0.0
) -> ToolInView:
    tip_in_marker = tool.marker_from_tool.translation_mm
    return ToolInView(
        camera_from_tool=pose @ tool.marker_from_tool,
        tip_covariance_mm2=point_covariance_mm2(pose, covariance, tip_in_marker),
        lag_ms=lag_ms,
    )


def _tip_sd_mm(tool: ToolInView) -> float:
    return float(np.sqrt(np.trace(tool.tip_covariance_mm2)))


def placed_vertebra(
    setup: Setup, sightings: Mapping[str, Sighting], watched: Watched = UNWATCHED
) -> PlacedVertebra | Absent:
    """Where the plan's vertebra is in this image, or why that is not known."""
    registration = setup.registration
    if isinstance(registration, Absent):
        return registration
    if registration.anchored_to is AnchoredTo.CAMERA and watched.camera_moved:
        return Absent(reason=AbsentReason.CAMERA_MOVED)
    if registration.anchored_to is AnchoredTo.REFERENCE and watched.reference_moved:
        return Absent(reason=AbsentReason.REFERENCE_MOVED)
    if registration.anchored_to is AnchoredTo.CAMERA:
        fixed = registration.anchor_from_vertebra
        return PlacedVertebra(
            camera_from_vertebra=Rigid(rotation=fixed.rotation, translation_mm=fixed.translation_mm),
            covariance=registration.covariance,
            tip_slope=registration.tip_slope,
            tool=registration.tool,
        )
    seen = sightings.get(setup.reference)
    if not isinstance(seen, Seen):
        return Absent(reason=AbsentReason.REFERENCE_UNSEEN)
    if not setup.camera_calibrated:
        return Absent(reason=AbsentReason.CAMERA_NOT_CALIBRATED)
    if setup.reference in watched.jumped:
        return Absent(reason=AbsentReason.POSE_JUMPED)
    marker = seen.camera_from_marker
    camera_from_anchor: Rigid[Camera, Anchor] = Rigid(
        rotation=marker.rotation, translation_mm=marker.translation_mm
    )
    return PlacedVertebra(
        camera_from_vertebra=camera_from_anchor @ registration.anchor_from_vertebra,
        covariance=chained_covariance(
            camera_from_anchor,
            seen.pose_covariance,
            registration.anchor_from_vertebra,
            registration.covariance,
        ),
        tip_slope=np.vstack(
            [marker.rotation @ registration.tip_slope[:3], marker.rotation @ registration.tip_slope[3:]]
        ),
        tool=registration.tool,
    )


def _while_placed(
    setup: Setup, vertebra: PlacedVertebra | Absent, tool: ToolInView | Absent
) -> ToolInView | Absent:
    """The tool; once plan and patient are registered, only while it is known where the plan lies on them.

    A drill's line over a patient whose place was lost looks like navigation, and is none. Where a person has
    to confirm that place, the plan is shown for them to look at, and no drill.
    """
    if isinstance(tool, Absent):
        return tool
    if not isinstance(vertebra, Absent):
        is_stopped = setup.withheld is AbsentReason.NOT_CONFIRMED
        return Absent(reason=AbsentReason.NOT_CONFIRMED) if is_stopped else tool
    return tool if vertebra.reason is AbsentReason.NOT_REGISTERED else vertebra


def tool_deviation(
    setup: Setup, tool: ToolInView | Absent, vertebra: PlacedVertebra | Absent
) -> Deviation | Absent:
    """The tool's deviation from the channel, or why it is not known."""
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


def _judged(
    setup: Setup,
    guide: Guide | None,
    vertebra: PlacedVertebra | Absent,
    sighting: Sighting,
    name: str,
    steadied: SteadyPose | None,
) -> Judged | Absent:
    """What the guide says of a tool that has a deviation."""
    if guide is None or isinstance(setup.channel, Absent):
        return Absent(reason=AbsentReason.NO_PLAN)
    if isinstance(vertebra, Absent):
        return vertebra
    if not isinstance(sighting, Seen):
        return Absent(reason=AbsentReason.MARKER_UNSEEN)
    tool = setup.tools[name]
    pose, covariance = sighting.camera_from_marker, sighting.pose_covariance
    # The same choice as in `tool_in_view`: a steadied pose that is too unsure is not the one shown.
    if steadied is not None:
        steady = _placed(tool, steadied.camera_from_marker, steadied.pose_covariance)
        if _tip_sd_mm(steady) <= setup.max_tip_sd_mm:
            pose, covariance = steadied.camera_from_marker, steadied.pose_covariance
    placed = placed_tool(
        Placed(pose=vertebra.camera_from_vertebra, covariance=vertebra.covariance),
        Placed(pose=pose, covariance=covariance),
        tool,
        tip_slope=vertebra.tip_slope_for(tool),
    )
    return guide.judged(placed, tool, setup.channel)


def _assessed(setup: Setup, deviation: Deviation | Absent, judged: Judged | Absent) -> Assessment | Absent:
    """The figures of a tool, or why it has none."""
    if isinstance(deviation, Absent):
        return deviation
    if isinstance(setup.channel, Absent):
        return setup.channel
    return assess(deviation, None if isinstance(judged, Absent) else judged, setup.channel, setup.limits)


def navigate(
    *,
    setup: Setup,
    sightings: Mapping[str, Sighting],
    image_number: int,
    captured_at_s: float,
    size_wh_px: tuple[int, int],
    stage_ms: Mapping[str, float],
    skipped_images: int,
    steadied: Mapping[str, SteadyPose] | None = None,
    guide: Guide | None = None,
    watched: Watched = UNWATCHED,
) -> NavigationSnapshot:
    """The snapshot of one image from what was seen in it.

    Where a tool's pose was steadied (`Steadying`), everything that is said of the tool comes from that pose.
    Without a guide nothing is said of clearances.
    """
    steady = steadied or {}
    vertebra = placed_vertebra(setup, sightings, watched)
    tools = {
        name: _while_placed(
            setup, vertebra, tool_in_view(setup, tool, sightings[tool.marker], steady.get(name), watched)
        )
        for name, tool in setup.tools.items()
    }
    deviations = {name: tool_deviation(setup, tool, vertebra) for name, tool in tools.items()}
    judgements = {
        name: one
        if isinstance(one, Absent)
        else _judged(setup, guide, vertebra, sightings[setup.tools[name].marker], name, steady.get(name))
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
        judgements=judgements,
        assessments={name: _assessed(setup, one, judgements[name]) for name, one in deviations.items()},
        watched=watched,
        stage_ms=stage_ms,
        skipped_images=skipped_images,
    )
