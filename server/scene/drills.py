"""Nodes of a drill: the drill, the uncertainty of its pose, and the trace of its tip."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import viser

from server.scene.nodes import World, add_tool, quaternion, vector
from server.scene.trace import Trace
from tracker.geometry import Rigid, Tool, rotation_from_half_axes
from tracker.navigation.uncertainty import DrillUncertainty
from tracker.pose import ToolModel

SPREAD = (190, 110, 255)
TRACE = (255, 196, 120)
TRACE_PX = 3.0
TIP_NODE, CONE_NODE = "/tip", "/cone"
CONE_MM = 45.0
# Minimum drawn half axis: a thinner ellipsoid would be invisible.
MIN_MM = 0.05
CORNERS = 24
NO_SEGMENT = np.zeros((1, 2, 3), np.float32)


@dataclass(frozen=True, slots=True, kw_only=True)
class DrillNow:
    """A drill in one image.

    Attributes:
        world_from_tool: Pose in the scene.
        spread: Uncertainty of the pose in the vertebra frame; None if unknown.
        leaves_trace: Whether the world is the vertebra frame, in which earlier positions are meaningful.
        at_s: Time of the image.
    """

    world_from_tool: Rigid[World, Tool]
    spread: DrillUncertainty | None
    leaves_trace: bool
    at_s: float


class DrillNodes:
    """The nodes of one drill, hidden until its pose is known. Mutable."""

    def __init__(self, scene: viser.SceneApi, node: str, tool: ToolModel) -> None:
        self._frame = add_tool(scene, node, tool)
        self._cone = scene.add_mesh_simple(
            f"{node}{CONE_NODE}",
            *_cone(),
            color=SPREAD,
            opacity=0.25,
            visible=False,
            side="double",
            cast_shadow=False,
            receive_shadow=False,
        )
        self._ellipsoid = scene.add_icosphere(
            f"{node}_at{TIP_NODE}",
            radius=1.0,
            color=SPREAD,
            opacity=0.6,
            visible=False,
            cast_shadow=False,
            receive_shadow=False,
        )
        self._line = scene.add_line_segments(
            f"{node}_trace",
            NO_SEGMENT,
            TRACE,
            thickness=TRACE_PX,
            thickness_units="screen",
            visible=False,
        )
        self._trace = Trace()

    def show(self, now: DrillNow | None) -> None:
        """Show the drill in its present pose; None hides all its nodes."""
        self._frame.visible = now is not None
        self._show_spread(now)
        self._show_trace(now)
        if now is not None:
            self._frame.position = vector(now.world_from_tool.translation_mm)
            self._frame.wxyz = quaternion(now.world_from_tool.rotation)

    @property
    def visible(self) -> bool:
        """Whether any of its nodes is visible."""
        return any(node.visible for node in (self._frame, self._cone, self._ellipsoid, self._line))

    def _show_spread(self, now: DrillNow | None) -> None:
        spread = None if now is None else now.spread
        self._ellipsoid.visible = self._cone.visible = spread is not None
        if now is None or spread is None:
            return
        reach_mm = np.maximum(np.linalg.norm(spread.tip_ellipsoid_mm, axis=1), MIN_MM)
        self._ellipsoid.scale = vector(reach_mm)
        self._ellipsoid.wxyz = quaternion(rotation_from_half_axes(spread.tip_ellipsoid_mm))
        self._ellipsoid.position = vector(now.world_from_tool.translation_mm)
        wide_mm = max(CONE_MM * float(np.tan(np.radians(min(spread.cone_95_deg, 60.0)))), MIN_MM)
        self._cone.scale = (wide_mm, wide_mm, CONE_MM)

    def _show_trace(self, now: DrillNow | None) -> None:
        if now is None or not now.leaves_trace:
            self._line.visible = False
            return
        if self._trace.take(now.world_from_tool.translation_mm, at_s=now.at_s):
            segments = self._trace.segments_mm
            self._line.points = segments.astype(np.float32) if len(segments) else NO_SEGMENT
        self._line.visible = len(self._trace.segments_mm) > 0


def _cone() -> tuple[npt.NDArray[np.float32], npt.NDArray[np.uint32]]:
    """Return an open cone of height and radius 1 with its apex at the origin."""
    turn = np.linspace(0.0, 2.0 * np.pi, CORNERS, endpoint=False)
    ring = np.stack([np.cos(turn), np.sin(turn), np.ones(CORNERS)], axis=1)
    corner = np.arange(CORNERS)
    faces = np.stack([np.zeros(CORNERS, int), 1 + corner, 1 + (corner + 1) % CORNERS], axis=1)
    return np.concatenate([np.zeros((1, 3)), ring]).astype(np.float32), faces.astype(np.uint32)
