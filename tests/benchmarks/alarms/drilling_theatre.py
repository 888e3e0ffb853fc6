"""Simulated drilling with ground truth, up to the alarms: from rendered images or from simulated poses."""

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from server.alarms import AlarmService
from server.capture.shot import Shot
from server.config import Config
from server.live import ProcessState, ProcessStatus, SourceState, SourceStatus
from server.loop.tracking import Tracking
from server.setup import Preparation, build_setup
from tracker.geometry import Anchor, Array, Camera, Marker, Rigid, Tool, Vertebra
from tracker.navigation import NavigationSnapshot, navigate
from tracker.navigation.alarms import AlarmState, Condition
from tracker.navigation.clearance import NearestWall, WallDistanceField, clearance_of_drill, drill_rings
from tracker.plan import Channel
from tracker.pose import Seen
from tracker.registration import AnchoredTo, Registration
from tracker.registration.points import PointPairs, register_points
from tracker.rehearsal import Theatre

# Between these times the breaching drill moves from well inside to through the wall.
BREACH_BETWEEN_S, HALVINGS = (16.0, 23.0), 20
RUNS = SourceStatus(name="rehearsal", state=SourceState.RUNNING)
WORKS = ProcessStatus(state=ProcessState.RUNNING)
# Clearance of a drill outside the bone.
NOT_ENTERED_CLEARANCE_MM = 100.0
# Landmark capture error of a hand, sd along each axis.
CAPTURE_SD_MM = 0.3
# Pose sd of a good tracker at 1280x720: across and along the sight, then of its angles.
POSE_SD = np.array([0.01, 0.01, 0.06, 0.0006, 0.0006, 0.0003])


@dataclass(slots=True, kw_only=True)
class AlarmCounts:
    """Alarms raised over a number of images.

    Attributes:
        images: how many there were.
        clear_images: of these, with a true clearance over the warning distance.
        min_mm: the minimum true clearance.
        raised: alarms by condition, at any image.
        raised_while_clear: of these, while the true clearance was over the warning distance.
    """

    images: int = 0
    clear_images: int = 0
    min_mm: float = NOT_ENTERED_CLEARANCE_MM
    raised: Counter[str] = field(default_factory=Counter)
    raised_while_clear: Counter[str] = field(default_factory=Counter)


class DrillingTheatre:
    """A theatre with a realistic set-up: its registration with landmarks has an error.

    Args:
        seed: of theatre and errors.
        skill: of the drilling hand.

    """

    def __init__(self, seed: int, *, skill: str = "good") -> None:
        rehearsal = {"seed": seed, "skill": skill, "reference": True}
        self.config = Config.model_validate({"rehearsal": rehearsal})
        exact = build_setup(self.config)
        assert exact.theatre is not None
        assert isinstance(exact.channel, Channel)
        self.theatre: Theatre = exact.theatre
        self.channel = exact.channel
        self.random = np.random.default_rng([seed, 0x414C41])
        # The wall of the rehearsed bone, which is exact only in the rehearsal's registration.
        self.drill_reference = exact.drill_reference_for(exact.channel)
        registration = captured_registration(self.theatre, self.random)
        self.preparation: Preparation = replace(
            exact, registration=registration, drill_reference=self.drill_reference
        )
        self.now_s = 0.0
        self._service = AlarmService(self.config, clock=lambda: self.now_s)
        self._active: frozenset[int] = frozenset()

    def true_clearance_mm(self, at_s: float) -> float:
        """Return the clearance between the true drill and the true wall."""
        truth = self.theatre.truth_at(at_s)
        return clearance_mm(
            truth.camera_from_vertebra.inverse @ truth.camera_from_tool,
            self.channel,
            self.drill_reference.wall,
            self.theatre,
        )

    def simulated(self, number: int, at_s: float) -> NavigationSnapshot:
        """Return the snapshot from simulated sightings with their stated noise."""
        setup = self.preparation.setup
        assert setup is not None
        truth = self.theatre.truth_at(at_s)
        assert truth.camera_from_reference is not None
        reference: Rigid[Camera, Marker] = Rigid(
            rotation=truth.camera_from_reference.rotation,
            translation_mm=truth.camera_from_reference.translation_mm,
        )
        return navigate(
            setup=setup,
            sightings={"drill": self._seen(truth.camera_from_marker), "reference": self._seen(reference)},
            image_number=number,
            captured_at_s=at_s,
            size_wh_px=setup.camera.size_wh_px,
            stage_ms={},
            skipped_images=0,
            drill_reference=self.drill_reference,
        )

    def stationary_at(self, limit_mm: float) -> Callable[[int, float], NavigationSnapshot]:
        """Return a source of snapshots of a drill held at this measured clearance.

        The theatre's drill must go through the wall: it is stopped on its way.

        """
        low_s, high_s = BREACH_BETWEEN_S
        for _ in range(HALVINGS):
            middle_s = 0.5 * (low_s + high_s)
            is_before = self._registered_clearance_mm(middle_s) > limit_mm
            low_s, high_s = (middle_s, high_s) if is_before else (low_s, middle_s)
        return lambda number, at_s: replace(self.simulated(number, low_s), captured_at_s=at_s)

    def _registered_clearance_mm(self, at_s: float) -> float:
        """Return the clearance by the registration, without tracking noise."""
        registration = self.preparation.registration
        assert isinstance(registration, Registration)
        truth = self.theatre.truth_at(at_s)
        assert truth.camera_from_reference is not None
        anchor_from_camera: Rigid[Anchor, Camera] = Rigid(
            rotation=truth.camera_from_reference.inverse.rotation,
            translation_mm=truth.camera_from_reference.inverse.translation_mm,
        )
        placed = registration.anchor_from_vertebra.inverse @ (anchor_from_camera @ truth.camera_from_tool)
        return clearance_mm(placed, self.channel, self.drill_reference.wall, self.theatre)

    def rendered(self) -> Callable[[int, float], NavigationSnapshot]:
        """Return a source of snapshots from tracked, rendered images."""
        renderer, tracking = self.theatre.renderer(), Tracking(self.preparation)

        def conclude(number: int, at_s: float) -> NavigationSnapshot:
            image = renderer.image_at(at_s)
            shot = Shot(image=image, number=number, captured_at_s=at_s, source_time_s=at_s)
            return tracking.process(shot, skipped_images=0, clock=lambda: at_s)

        return conclude

    def drill(
        self,
        conclude: Callable[[int, float], NavigationSnapshot],
        *,
        seconds: float,
        rate_hz: float,
        counts: AlarmCounts,
    ) -> None:
        """Process images for this long and count the alarms raised."""
        limit_mm = self.config.alarms.warning_distance_mm
        for number in range(round(seconds * rate_hz)):
            at_s = self.now_s = number / rate_hz
            clearance = self.true_clearance_mm(at_s)
            is_clear = clearance > limit_mm
            counts.images += 1
            counts.clear_images += is_clear
            counts.min_mm = min(counts.min_mm, clearance)
            for condition in self._raised_by(conclude(number, at_s)):
                counts.raised[condition] += 1
                counts.raised_while_clear[condition] += is_clear

    def _raised_by(self, snapshot: NavigationSnapshot) -> list[Condition]:
        self._service.report_screen("theatre-one", armed=True)
        picture = self._service.observe(snapshot, RUNS, WORKS)
        active = {one.number: one.condition for one in picture.alarms if one.state is AlarmState.ACTIVE}
        new = [condition for number, condition in active.items() if number not in self._active]
        self._active = frozenset(active)
        return new

    def _seen(self, pose: Rigid[Camera, Marker]) -> Seen:
        error = self.random.normal(0.0, POSE_SD)
        return Seen(
            camera_from_marker=pose.displaced(error),
            pose_covariance=np.diag(POSE_SD**2),
            corners_px=np.zeros((4, 2)),
            score_ratio=0.95,
            target_score_ratio=0.9,
            model_coverage_ratio=0.95,
            target_coverage_ratio=0.9,
            fit_error_px2=0.1,
            found_by="track",
        )


def captured_registration(theatre: Theatre, random: np.random.Generator) -> Registration:
    """Return the registration from all landmarks captured with the error of a hand."""
    landmarks: Array = np.array([one.point_in_vertebra_mm for one in theatre.landmarks])
    anchor_from_vertebra: Rigid[Anchor, Vertebra] = Rigid(
        rotation=theatre.reference_from_vertebra.rotation,
        translation_mm=theatre.reference_from_vertebra.translation_mm,
    )
    touched = anchor_from_vertebra.move_points(landmarks) + random.normal(0.0, CAPTURE_SD_MM, landmarks.shape)
    spread = np.tile(CAPTURE_SD_MM**2 * np.eye(3), (len(landmarks), 1, 1))
    pairs = PointPairs(fixed_mm=landmarks, moving_mm=touched, moving_covariances_mm2=spread)
    return register_points(pairs).registration(AnchoredTo.REFERENCE)


def clearance_mm(
    vertebra_from_tool: Rigid[Vertebra, Tool], channel: Channel, wall: WallDistanceField, theatre: Theatre
) -> float:
    """Return the minimum clearance of the drill at this pose."""
    tool = theatre.tool
    rings = drill_rings(vertebra_from_tool, channel, wall, radius_mm=tool.radius_mm, length_mm=tool.length_mm)
    now = clearance_of_drill(rings, vertebra_from_tool, channel).now
    return now.clearance_mm if isinstance(now, NearestWall) else NOT_ENTERED_CLEARANCE_MM
