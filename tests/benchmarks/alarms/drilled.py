"""Drilling in a theatre whose truth is known, up to the alarms: image by image, or pose by pose."""

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from server.alarms import AlarmDesk
from server.capture.shot import Shot
from server.config import Config
from server.live import ProcessState, ProcessStatus, SourceState, SourceStatus
from server.loop.tracking import Tracking
from server.setup import Preparation, build_setup
from tracker.geometry import Anchor, Array, Camera, Marker, Rigid, Tool, Vertebra, rotation_from_vector
from tracker.navigation import NavigationSnapshot, navigate
from tracker.navigation.alarms import AlarmState, Condition
from tracker.navigation.clearance import Nearest, WallField, clearance_of_drill, drill_rings
from tracker.plan import Channel
from tracker.pose import Seen
from tracker.registration import AnchoredTo, Registration
from tracker.registration.points import PairedPoints, register_points
from tracker.rehearsal import Theatre

# Between these it goes from well inside to through the wall.
HELD_BETWEEN_S, HALVINGS = (16.0, 23.0), 20
RUNS = SourceStatus(name="rehearsal", state=SourceState.RUNNING)
WORKS = ProcessStatus(state=ProcessState.RUNNING)
# A drill that is not in the bone is as far from its walls as can be.
NOT_ENTERED_MM = 100.0
# What a hand that touches a landmark errs by, in each direction.
TOUCH_SD_MM = 0.3
# What a good tracker is unsure by at 1280x720: across and along the sight, then of its angles.
POSE_SD = np.array([0.01, 0.01, 0.06, 0.0006, 0.0006, 0.0003])


@dataclass(slots=True, kw_only=True)
class Told:
    """What came of some images.

    Attributes:
        images: how many there were.
        roomy: of these, with a true clearance over the warning distance.
        min_mm: the least true clearance of all.
        raised: alarms by condition, at any image.
        raised_in_roomy: of these, while the true clearance was over the warning distance.
    """

    images: int = 0
    roomy: int = 0
    min_mm: float = NOT_ENTERED_MM
    raised: Counter[str] = field(default_factory=Counter)
    raised_in_roomy: Counter[str] = field(default_factory=Counter)


class DrilledTheatre:
    """A theatre with everything known as a procedure would know it: a registration by points that errs.

    Args:
        seed: of theatre and errors.
        skill: how the hand drills.
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
        # The wall of the rehearsed bone, which is known with the registration of the rehearsal alone.
        self.guide = exact.guide_along(exact.channel)
        registration = touched_registration(self.theatre, self.random)
        self.preparation: Preparation = replace(exact, registration=registration, guide=self.guide)
        self.now_s = 0.0
        self._desk = AlarmDesk(self.config, clock=lambda: self.now_s)
        self._standing: frozenset[int] = frozenset()

    def true_clearance_mm(self, at_s: float) -> float:
        """From the true drill to the true wall."""
        truth = self.theatre.truth_at(at_s)
        return clearance_mm(
            truth.camera_from_vertebra.inverse @ truth.camera_from_tool,
            self.channel,
            self.guide.wall,
            self.theatre,
        )

    def simulated(self, number: int, at_s: float) -> NavigationSnapshot:
        """What is concluded from markers that are seen as unsure as is stated."""
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
            guide=self.guide,
        )

    def held_at(self, limit_mm: float) -> Callable[[int, float], NavigationSnapshot]:
        """Concludes from markers of a drill that stands still where its clearance seems to be this much.

        The theatre's drill must go through the wall: it is held at a moment on its way.
        """
        low_s, high_s = HELD_BETWEEN_S
        for _ in range(HALVINGS):
            middle_s = 0.5 * (low_s + high_s)
            is_before = self._registered_clearance_mm(middle_s) > limit_mm
            low_s, high_s = (middle_s, high_s) if is_before else (low_s, middle_s)
        return lambda number, at_s: replace(self.simulated(number, low_s), captured_at_s=at_s)

    def _registered_clearance_mm(self, at_s: float) -> float:
        """As seen without noise, by the registration."""
        registration = self.preparation.registration
        assert isinstance(registration, Registration)
        truth = self.theatre.truth_at(at_s)
        assert truth.camera_from_reference is not None
        anchor_from_camera: Rigid[Anchor, Camera] = Rigid(
            rotation=truth.camera_from_reference.inverse.rotation,
            translation_mm=truth.camera_from_reference.inverse.translation_mm,
        )
        placed = registration.anchor_from_vertebra.inverse @ (anchor_from_camera @ truth.camera_from_tool)
        return clearance_mm(placed, self.channel, self.guide.wall, self.theatre)

    def rendered(self) -> Callable[[int, float], NavigationSnapshot]:
        """Concludes what is tracked in rendered images."""
        renderer, tracking = self.theatre.renderer(), Tracking(self.preparation)

        def conclude(number: int, at_s: float) -> NavigationSnapshot:
            image = renderer.image_at(at_s)
            shot = Shot(image=image, number=number, captured_at_s=at_s, source_time_s=at_s)
            return tracking.conclude(shot, skipped_images=0, clock=lambda: at_s)

        return conclude

    def drill(
        self,
        conclude: Callable[[int, float], NavigationSnapshot],
        *,
        seconds: float,
        rate_hz: float,
        told: Told,
    ) -> None:
        """Look at so many seconds of images, and count what is raised."""
        limit_mm = self.config.alarms.warning_distance_mm
        for number in range(round(seconds * rate_hz)):
            at_s = self.now_s = number / rate_hz
            clearance = self.true_clearance_mm(at_s)
            is_roomy = clearance > limit_mm
            told.images += 1
            told.roomy += is_roomy
            told.min_mm = min(told.min_mm, clearance)
            for condition in self._raised_by(conclude(number, at_s)):
                told.raised[condition] += 1
                told.raised_in_roomy[condition] += is_roomy

    def _raised_by(self, snapshot: NavigationSnapshot) -> list[Condition]:
        self._desk.screen_said("theatre-one", armed=True)
        picture = self._desk.look(snapshot, RUNS, WORKS)
        active = {one.number: one.condition for one in picture.alarms if one.state is AlarmState.ACTIVE}
        new = [condition for number, condition in active.items() if number not in self._standing]
        self._standing = frozenset(active)
        return new

    def _seen(self, pose: Rigid[Camera, Marker]) -> Seen:
        error = self.random.normal(0.0, POSE_SD)
        return Seen(
            camera_from_marker=Rigid(
                rotation=rotation_from_vector(error[3:]) @ pose.rotation,
                translation_mm=pose.translation_mm + error[:3],
            ),
            pose_covariance=np.diag(POSE_SD**2),
            corners_px=np.zeros((4, 2)),
            score_ratio=0.95,
            target_score_ratio=0.9,
            model_coverage_ratio=0.95,
            target_coverage_ratio=0.9,
            fit_error_px2=0.1,
            found_by="track",
        )


def touched_registration(theatre: Theatre, random: np.random.Generator) -> Registration:
    """The registration that comes of touching all landmarks of the theatre as well as a hand can."""
    landmarks: Array = np.array([one.point_in_vertebra_mm for one in theatre.landmarks])
    anchor_from_vertebra: Rigid[Anchor, Vertebra] = Rigid(
        rotation=theatre.reference_from_vertebra.rotation,
        translation_mm=theatre.reference_from_vertebra.translation_mm,
    )
    touched = anchor_from_vertebra.move_points(landmarks) + random.normal(0.0, TOUCH_SD_MM, landmarks.shape)
    spread = np.tile(TOUCH_SD_MM**2 * np.eye(3), (len(landmarks), 1, 1))
    pairs = PairedPoints(fixed_mm=landmarks, moving_mm=touched, moving_covariances_mm2=spread)
    return register_points(pairs).registration(AnchoredTo.REFERENCE)


def clearance_mm(
    vertebra_from_tool: Rigid[Vertebra, Tool], channel: Channel, wall: WallField, theatre: Theatre
) -> float:
    """The least clearance of the drill at this place."""
    tool = theatre.tool
    rings = drill_rings(vertebra_from_tool, channel, wall, radius_mm=tool.radius_mm, length_mm=tool.length_mm)
    now = clearance_of_drill(rings, vertebra_from_tool, channel).now
    return now.clearance_mm if isinstance(now, Nearest) else NOT_ENTERED_MM
