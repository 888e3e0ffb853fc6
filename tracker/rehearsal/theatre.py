"""The theatre: camera, marker, drill, vertebra and needles, and where they all are at any time."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import numpy as np

from tracker.camera import CameraModel
from tracker.geometry import Array, Camera, Marker, Rigid, Tool, Vertebra
from tracker.marker import MarkerModel
from tracker.plan import Channel, Surface
from tracker.pose import ToolModel
from tracker.rehearsal.anatomy import Needle, landmark_needles, pedicle_channels, vertebra_surface
from tracker.rehearsal.emblem import drill_emblem
from tracker.rehearsal.hands import PivotingHand, SpinningHand
from tracker.rehearsal.motion import CYCLE_S, Hand, Phase, Pose6, phase_at
from tracker.rehearsal.settings import Scene, TheatreSettings

if TYPE_CHECKING:
    from tracker.rehearsal.board_renderer import BoardRenderer
    from tracker.rehearsal.renderer import Renderer

MARKER_SIDE_MM = 25.0
QUIET_ZONE_MM = 4.5
# The board is fixed to the front of the handpiece, so the drill's axis runs just behind its plane.
TIP_IN_MARKER_MM = (0.0, -120.0, -10.0)
AXIS_IN_MARKER = (0.0, -1.0, 0.0)
DRILL_RADIUS_MM, DRILL_LENGTH_MM = 2.0, 118.0

# A 1280 px wide sensor sees 49 degrees; other widths see the same.
FOCAL_OF_WIDTH = 1400.0 / 1280.0
SQUARE_IN_MM = np.array([[-0.5, 0.5, 0], [0.5, 0.5, 0], [0.5, -0.5, 0], [-0.5, -0.5, 0]]) * MARKER_SIDE_MM
VIEW_MARGIN_PX = 6.0
STEEPEST_VIEW_COSINE = 0.26  # 75 degrees off: nobody can read a marker from there


class _Holding(Protocol):
    """Whatever moves the drill."""

    def at(self, at_s: float) -> Pose6:
        """Where the drill is held at this time."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Truth:
    """What is true in the theatre at one time.

    Attributes:
        at_s: the time.
        phase: what the hand is doing.
        camera_from_marker: the marker.
        camera_from_tool: the drill: tip and drilling direction.
        camera_from_vertebra: the patient, who lies still.
        marker_in_view: the whole black square with its quiet zone is in the image, with a margin, and faces
            the camera.
        corners_px: (4, 2) of the black square, top-left, top-right, bottom-right, bottom-left of the printed
            face; they may lie outside the image.
    """

    at_s: float
    phase: Phase
    camera_from_marker: Rigid[Camera, Marker]
    camera_from_tool: Rigid[Camera, Tool]
    camera_from_vertebra: Rigid[Camera, Vertebra]
    marker_in_view: bool
    corners_px: Array


class Theatre:
    """A theatre that exists only in software; everything in it follows from the settings.

    Attributes:
        settings: what it was built from.
        camera: its camera, with a lens that bends lines.
        marker: the square on the drill ("drill", 25 mm).
        tool: the drill behind that marker.
        channels: the left and the right pedicle's; the drill follows the first.
        camera_from_vertebra: the registration, exactly.
        surface: the vertebra.
        needles: the three landmark needles.
        cycle_s: the motion repeats after this.
    """

    def __init__(self, settings: TheatreSettings) -> None:
        random = np.random.default_rng([settings.seed, 0x524F4F4D])
        self.settings = settings
        self.cycle_s = CYCLE_S
        self.camera = _camera(settings, random)
        self.marker = MarkerModel.from_image(drill_emblem(), side_mm=MARKER_SIDE_MM, name="drill")
        self.tool = ToolModel.from_tip_and_axis(
            name="drill",
            marker="drill",
            tip_in_marker_mm=TIP_IN_MARKER_MM,
            axis_in_marker=AXIS_IN_MARKER,
            radius_mm=DRILL_RADIUS_MM,
            length_mm=DRILL_LENGTH_MM,
        )
        self.channels: tuple[Channel, ...] = pedicle_channels()
        self.surface: Surface = vertebra_surface()
        self.needles: tuple[Needle, ...] = landmark_needles()
        self.camera_from_vertebra = _camera_from_vertebra(self.channels[0], random)
        self._hand = _hand_of(settings)
        self._vertebra_from_rest = _vertebra_from_rest(self.channels[0], self.camera_from_vertebra)

    def truth_at(self, at_s: float) -> Truth:
        """What is true at this time (any number of seconds); costs well under a millisecond."""
        camera_from_tool = self.camera_from_tool_at(at_s)
        camera_from_marker = camera_from_tool @ self.tool.marker_from_tool.inverse
        # The tool is made from the marker once more, so that the two agree to the last bit.
        camera_from_tool = camera_from_marker @ self.tool.marker_from_tool
        corners = camera_from_marker.move_points(SQUARE_IN_MM)
        return Truth(
            at_s=at_s,
            phase=phase_at(at_s) if self.settings.scene is Scene.OPERATION else Phase.CALIBRATE,
            camera_from_marker=camera_from_marker,
            camera_from_tool=camera_from_tool,
            camera_from_vertebra=self.camera_from_vertebra,
            marker_in_view=self._in_view(camera_from_marker),
            corners_px=self.camera.px_from_camera(corners),
        )

    def renderer(self) -> "Renderer | BoardRenderer":
        """What makes the images of its scene; rendering what stands still takes about a second."""
        from tracker.rehearsal.board_renderer import BoardRenderer  # noqa: PLC0415  they need the theatre first
        from tracker.rehearsal.renderer import Renderer  # noqa: PLC0415

        return BoardRenderer(self) if self.settings.scene is Scene.BOARD else Renderer(self)

    def camera_from_tool_at(self, at_s: float) -> Rigid[Camera, Tool]:
        """The drill's tip and drilling direction at this time."""
        hand = self._hand.at(at_s)
        tip_mm = np.append(hand.across_mm, hand.depth_mm)
        held: Rigid[Tool, Tool] = Rigid.from_vector(np.radians(hand.turn_deg), tip_mm)
        return self.camera_from_vertebra @ (self._vertebra_from_rest @ held)

    def _in_view(self, camera_from_marker: Rigid[Camera, Marker]) -> bool:
        quiet = SQUARE_IN_MM * (1.0 + 2.0 * QUIET_ZONE_MM / MARKER_SIDE_MM)
        outline = camera_from_marker.move_points(quiet)
        centre = camera_from_marker.translation_mm
        facing = -float(camera_from_marker.rotation[:, 2] @ centre) / float(np.linalg.norm(centre))
        if outline[:, 2].min() < 50.0 or facing < STEEPEST_VIEW_COSINE:
            return False
        px = self.camera.px_from_camera(outline)
        last = np.array(self.camera.size_wh_px) - 1.0 - VIEW_MARGIN_PX
        return bool((px >= VIEW_MARGIN_PX).all() and (px <= last).all())


def _hand_of(settings: TheatreSettings) -> _Holding:
    match settings.scene:
        case Scene.PIVOT:
            return PivotingHand(settings.seed)
        case Scene.SPIN:
            return SpinningHand(settings.seed)
        case _:
            return Hand(settings.seed)


def _camera(settings: TheatreSettings, random: np.random.Generator) -> CameraModel:
    width, height = settings.size_wh_px
    focal = FOCAL_OF_WIDTH * width * random.uniform(0.985, 1.015)
    centre = np.array([width / 2 - 0.5, height / 2 - 0.5]) + random.normal(0.0, 0.006, 2) * width
    matrix = np.array([[focal, 0.0, centre[0]], [0.0, focal * 1.001, centre[1]], [0.0, 0.0, 1.0]])
    k1, k2 = random.uniform(-0.19, -0.13), random.uniform(0.03, 0.06)
    p1, p2 = random.normal(0.0, 3e-4, 2)
    return CameraModel(
        matrix=matrix, distortion=np.array([k1, k2, p1, p2, 0.0]), size_wh_px=settings.size_wh_px
    )


def _camera_from_vertebra(channel: Channel, random: np.random.Generator) -> Rigid[Camera, Vertebra]:
    """The camera beside the prone patient's hip, looking obliquely at the drill from the side.

    A marker whose plane holds the drill's axis can only be read from the side: the line of sight is about 50
    degrees off the channel.
    """
    elevation, azimuth = np.radians([random.uniform(33.0, 37.0), random.uniform(18.0, 30.0)])
    sight = -np.array(
        [np.cos(elevation) * np.sin(azimuth), np.sin(elevation), -np.cos(elevation) * np.cos(azimuth)]
    )
    backwards = np.array([0.0, 1.0, 0.0])
    right = np.cross(sight, backwards)
    right /= np.linalg.norm(right)
    down = np.cross(sight, right)
    lean = np.radians(random.uniform(-2.5, 2.5))
    rows = np.stack(
        [np.cos(lean) * right + np.sin(lean) * down, np.cos(lean) * down - np.sin(lean) * right, sight]
    )
    # Look at a point some way up the drill, so that bone and marker share the picture.
    aim = channel.entry_in_vertebra_mm - 76.0 * channel.axis_in_vertebra
    distance_mm = random.uniform(455.0, 475.0)
    return Rigid(rotation=rows, translation_mm=np.array([0.0, 0.0, distance_mm]) - rows @ aim)


def _vertebra_from_rest(
    channel: Channel, camera_from_vertebra: Rigid[Camera, Vertebra]
) -> Rigid[Vertebra, Tool]:
    """The drill exactly in the channel, tip on the entry point, its marker turned to the camera."""
    down = channel.axis_in_vertebra
    to_camera = camera_from_vertebra.inverse.translation_mm - channel.entry_in_vertebra_mm
    face = to_camera - (to_camera @ down) * down
    face /= np.linalg.norm(face)
    rotation = np.stack([np.cross(face, down), face, down], axis=1)
    return Rigid(rotation=rotation, translation_mm=channel.entry_in_vertebra_mm)
