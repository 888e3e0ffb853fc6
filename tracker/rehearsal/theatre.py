"""The simulated theatre: poses of camera, marker, drill, vertebra and needles at any time."""

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Protocol, TypeVar

import numpy as np

from tracker.camera import CameraModel
from tracker.geometry import Array, Camera, Marker, Reference, Rigid, Tool, Vertebra
from tracker.marker import MarkerModel
from tracker.plan import Channel, Surface
from tracker.pose import ToolModel
from tracker.rehearsal.anatomy import Needle, landmark_needles, pedicle_channels, vertebra_surface
from tracker.rehearsal.calibration_hands import PivotingHand, SpinningHand
from tracker.rehearsal.capture_hands import landmark_hand, sweep_hand
from tracker.rehearsal.drilling import drilling_hand
from tracker.rehearsal.events import EventKind
from tracker.rehearsal.landmarks import Landmark, check_landmark, registration_landmarks
from tracker.rehearsal.marker_images import drill_marker_image
from tracker.rehearsal.motion import Phase, Pose6
from tracker.rehearsal.placement import Moves, Placement, Room
from tracker.rehearsal.reference import (
    reference_board_mm,
    reference_from_vertebra,
    reference_marker,
)
from tracker.rehearsal.settings import Scene, TheatreSettings

Square = TypeVar("Square")

if TYPE_CHECKING:
    from tracker.rehearsal.backdrop import StillStore
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
QUIET_SQUARE_MM = SQUARE_IN_MM * (1.0 + 2.0 * QUIET_ZONE_MM / MARKER_SIDE_MM)
VIEW_MARGIN_PX = 6.0
MIN_VIEW_COSINE = 0.26  # a marker cannot be detected at more than 75 degrees


class HandMotion(Protocol):
    """Protocol of a hand that moves the drill."""

    @property
    def cycle_s(self) -> float:
        """Period of the motion."""

    def at(self, at_s: float, /) -> Pose6:
        """Return the drill pose at this time."""

    def phase_at(self, at_s: float, /) -> Phase:
        """Return the phase of the motion at this time."""

    def touched_at(self, at_s: float, /) -> str:
        """Return the name of the landmark under the tip; empty if there is none."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Truth:
    """Ground truth of the theatre at one time.

    Attributes:
        at_s: the time.
        phase: phase of the hand motion.
        camera_from_marker: the marker.
        camera_from_tool: the drill: tip and drilling direction.
        camera_from_vertebra: the patient, constant until an event moves it.
        camera_from_room: the static scene; the vertebra's frame before any motion.
        camera_from_reference: the marker on the patient; None where there is none.
        marker_in_view: the whole black square with its quiet zone is in the image, with a margin, faces
            the camera, and nothing lies over it.
        reference_in_view: the same of the marker on the patient.
        corners_px: (4, 2) of the black square, top-left, top-right, bottom-right, bottom-left of the printed
            face; they may lie outside the image.
        touched: name of the landmark on which the tip rests; empty for none.
    """

    at_s: float
    phase: Phase
    camera_from_marker: Rigid[Camera, Marker]
    camera_from_tool: Rigid[Camera, Tool]
    camera_from_vertebra: Rigid[Camera, Vertebra]
    camera_from_room: Rigid[Camera, Room]
    camera_from_reference: Rigid[Camera, Reference] | None
    marker_in_view: bool
    reference_in_view: bool
    corners_px: Array
    touched: str


@lru_cache(maxsize=1)
def drill_marker() -> MarkerModel:
    """Return the printed marker of the drill ("drill", 25 mm)."""
    return MarkerModel.from_image(drill_marker_image(), side_mm=MARKER_SIDE_MM, name="drill")


class Theatre:
    """A simulated theatre, fully determined by its settings.

    Attributes:
        settings: its settings.
        camera: its camera, with lens distortion.
        marker: the square on the drill ("drill", 25 mm).
        tool: the drill behind that marker.
        channels: the left and the right pedicle's; the drill follows the first.
        camera_from_vertebra: the registration to the camera, exactly, as long as nothing has moved.
        reference: the square on the patient ("reference", 30 mm); None where there is none.
        reference_from_vertebra: the registration to that square, exactly, whatever moves.
        surface: the vertebra.
        needles: the three landmark needles.
        landmarks: those that are captured, in order.
        check_landmark: the one reserved for the check.
        cycle_s: period of the motion.
    """

    def __init__(self, settings: TheatreSettings) -> None:
        random = np.random.default_rng([settings.seed, 0x524F4F4D])
        self.settings = settings
        self.camera = _camera(settings, random)
        self.marker = drill_marker()
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
        self.reference: MarkerModel | None = reference_marker() if settings.reference else None
        self.reference_from_vertebra = reference_from_vertebra(self.camera_from_vertebra, settings.seed)
        self._tool_from_marker = self.tool.marker_from_tool.inverse
        self._vertebra_from_reference = self.reference_from_vertebra.inverse
        self.landmarks: tuple[Landmark, ...] = registration_landmarks()
        self.check_landmark: Landmark = check_landmark()
        self._moves = Moves(settings, self.camera_from_vertebra)
        self._vertebra_from_rest = _vertebra_from_rest(self.channels[0], self.camera_from_vertebra)
        self._hand = _hand_of(settings, self._vertebra_from_rest)
        self.cycle_s = self._hand.cycle_s

    def truth_at(self, at_s: float) -> Truth:
        """Return the ground truth at this time (any number of seconds); well under a millisecond."""
        camera_from_marker = self.camera_from_marker_at(at_s)
        camera_from_tool = camera_from_marker @ self.tool.marker_from_tool
        corners = camera_from_marker.move_points(SQUARE_IN_MM)
        placement = self.placement_at(at_s)
        camera_from_reference = self._camera_from_reference(placement)
        return Truth(
            at_s=at_s,
            phase=self._hand.phase_at(at_s),
            camera_from_marker=camera_from_marker,
            camera_from_tool=camera_from_tool,
            camera_from_vertebra=placement.camera_from_vertebra,
            camera_from_room=placement.camera_from_room,
            camera_from_reference=camera_from_reference,
            marker_in_view=self.settings.scene is not Scene.BOARD
            and not self.is_on(EventKind.DRILL_HIDDEN, at_s)
            and self._in_view(camera_from_marker, QUIET_SQUARE_MM),
            reference_in_view=camera_from_reference is not None
            and not self.is_on(EventKind.REFERENCE_HIDDEN, at_s)
            and self._in_view(camera_from_reference, reference_board_mm()),
            corners_px=self.camera.px_from_camera(corners),
            touched=self._hand.touched_at(at_s),
        )

    @property
    def placement_at_rest(self) -> Placement:
        """Return the placement of camera and patient before any motion."""
        return self._moves.at_rest

    def placement_at(self, at_s: float) -> Placement:
        """Return the placement of camera and patient at this time."""
        return self._moves.placement_at(at_s)

    def placements(self) -> list[Placement]:
        """Return all placements of camera and patient that occur, the first one first."""
        return self._moves.placements()

    def is_on(self, kind: EventKind, at_s: float) -> bool:
        """Return whether an event of this kind is active at this time."""
        return any(event.kind is kind and event.is_on(at_s) for event in self.settings.events)

    def renderer(
        self, after: "Renderer | BoardRenderer | None" = None, store: "StillStore | None" = None
    ) -> "Renderer | BoardRenderer":
        """Return the renderer of its scene; rendering the static scenery takes about a second.

        `after` is the renderer of another scene of the same theatre: its static scenery is reused, else that
        of the store, if present.
        """
        from tracker.rehearsal.board_renderer import BoardRenderer  # noqa: PLC0415  they need the theatre first
        from tracker.rehearsal.renderer import Renderer  # noqa: PLC0415

        cached = None if after is None else after.backdrops
        kind = BoardRenderer if self.settings.scene is Scene.BOARD else Renderer
        return kind(self, cached, store)

    def camera_from_marker_at(self, at_s: float, *, late_s: float = 0.0) -> Rigid[Camera, Marker]:
        """Return the pose of the drill's marker at this time; the hand follows the patient.

        With `late_s` only the hand moves on by this time, without events, because an event happens between
        two images and is not a motion.
        """
        hand = self._hand.at(at_s + late_s)
        tip_mm = np.append(hand.across_mm, hand.depth_mm) + self._moves.jump_mm_at(at_s)
        hand_pose: Rigid[Tool, Tool] = Rigid.from_vector(np.radians(hand.rotation_deg), tip_mm)
        placement = self.placement_at(at_s)
        camera_from_tool = placement.camera_from_vertebra @ (self._vertebra_from_rest @ hand_pose)
        return camera_from_tool @ self._tool_from_marker

    def _camera_from_reference(self, placement: Placement) -> Rigid[Camera, Reference] | None:
        if self.reference is None:
            return None
        return placement.camera_from_vertebra @ self._vertebra_from_reference

    def _in_view(self, camera_from_square: Rigid[Camera, Square], outline_mm: Array) -> bool:
        outline = camera_from_square.move_points(outline_mm)
        centre = camera_from_square.translation_mm
        facing = -float(camera_from_square.rotation[:, 2] @ centre) / float(np.linalg.norm(centre))
        if outline[:, 2].min() < 50.0 or facing < MIN_VIEW_COSINE:
            return False
        px = self.camera.px_from_camera(outline)
        last = np.array(self.camera.size_wh_px) - 1.0 - VIEW_MARGIN_PX
        return bool((px >= VIEW_MARGIN_PX).all() and (px <= last).all())


def _hand_of(settings: TheatreSettings, rest: Rigid[Vertebra, Tool]) -> HandMotion:
    seed = settings.seed
    match settings.scene:
        case Scene.PIVOT:
            return PivotingHand(seed)
        case Scene.SPIN | Scene.BOARD:
            return SpinningHand(seed)
        case Scene.LANDMARKS:
            return landmark_hand(registration_landmarks(), rest_s=settings.rest_s, rest=rest, seed=seed)
        case Scene.CHECK:
            return landmark_hand((check_landmark(),), rest_s=settings.rest_s, rest=rest, seed=seed)
        case Scene.SWEEP:
            return sweep_hand(rest=rest, seed=seed)
        case Scene.OPERATION:
            return drilling_hand(settings.skill, seed=seed, rest=rest)


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
    """Return the camera pose beside the prone patient's hip, looking obliquely at the drill.

    A marker whose plane contains the drill's axis can only be seen from the side: the line of sight is
    about 50 degrees off the channel.
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
    """Return the drill pose in the channel, tip on the entry point, marker facing the camera."""
    down = channel.axis_in_vertebra
    to_camera = camera_from_vertebra.inverse.translation_mm - channel.entry_in_vertebra_mm
    face = to_camera - (to_camera @ down) * down
    face /= np.linalg.norm(face)
    rotation = np.stack([np.cross(face, down), face, down], axis=1)
    return Rigid(rotation=rotation, translation_mm=channel.entry_in_vertebra_mm)
