"""Images of one theatre as tracker and motion monitors receive them, with the ground truth beside them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from tracker.geometry import Rigid, Tool, Vertebra
from tracker.navigation import Absent, AbsentReason, MotionMonitor, MotionState, Setup
from tracker.pipeline import Tracker
from tracker.pose import Sighting
from tracker.registration import AnchoredTo
from tracker.rehearsal import Event, Phase, Scene, Theatre, TheatreSettings

ANCHORS = (AnchoredTo.CAMERA, AnchoredTo.REFERENCE)


@dataclass(frozen=True, slots=True, kw_only=True)
class Observation:
    """Sightings and ground truth of one image.

    Attributes:
        at_s: time on the theatre's clock.
        sightings: result of the tracker by marker name.
        motion: state of the motion monitors, without and with the reference.
        vertebra_from_tool: true pose of the tool.
        phase: true phase of the operation.
        touched: landmark on which the tip rests; empty for none.
    """

    at_s: float
    sightings: Mapping[str, Sighting]
    motion: Mapping[AnchoredTo, MotionState]
    vertebra_from_tool: Rigid[Vertebra, Tool]
    phase: Phase
    touched: str

    def sightings_for(self, anchor: AnchoredTo) -> Mapping[str, Sighting]:
        """Return the sightings; without the patient reference for a registration anchored to the camera."""
        if anchor is AnchoredTo.REFERENCE:
            return self.sightings
        return {name: one for name, one in self.sightings.items() if name != "reference"}


class TheatreObserver:
    """One camera in one theatre, over several scenes; tracker and motion monitors keep their state.

    Two motion monitors process the same images, one without and one with the reference.
    """

    def __init__(self, seed: int) -> None:
        self._settings = TheatreSettings(seed=seed, reference=True)
        self.theatre = Theatre(self._settings)
        if self.theatre.reference is None:
            raise RuntimeError("the theatre was created with a reference, but has none")
        self.models = (self.theatre.marker, self.theatre.reference)
        self._renderer = self.theatre.renderer()
        self._at_s = 0.0
        self.reset()

    def reset(self) -> None:
        """Discard the state of tracker and motion monitors."""
        self._tracker = Tracker(camera=self.theatre.camera, models=self.models)
        self._watching = {anchor: MotionMonitor() for anchor in ANCHORS}

    def scene(self, scene: Scene, events: tuple[Event, ...] = ()) -> Theatre:
        """Return the same theatre with another scene."""
        return Theatre(replace(self._settings, scene=scene, events=events))

    def register(self) -> None:
        """Start motion monitoring for a registration that began with the first image."""
        for watching in self._watching.values():
            watching.begin(from_s=0.0, now_s=self._at_s)

    def observations(self, theatre: Theatre, times_s: Sequence[float]) -> list[Observation]:
        """Return the observations of a scene at these increasing times."""
        renderer = theatre.renderer(after=self._renderer)
        self._renderer = renderer
        # Each scene has its own clock, but the tracker requires increasing times.
        since_s = self._at_s + 1.0 - times_s[0]
        found = []
        for time_s in times_s:
            image = renderer.image_at(time_s)
            self._at_s = since_s + time_s
            sightings = self._tracker.step(image, captured_at_s=self._at_s)
            truth = theatre.truth_at(time_s)
            observation = Observation(
                at_s=time_s,
                sightings=sightings,
                motion={},
                vertebra_from_tool=truth.camera_from_vertebra.inverse @ truth.camera_from_tool,
                phase=truth.phase,
                touched=truth.touched,
            )
            motion = {
                anchor: watching.take(
                    self._setup(anchor), image, observation.sightings_for(anchor), at_s=self._at_s
                )
                for anchor, watching in self._watching.items()
            }
            found.append(replace(observation, motion=motion))
        return found

    def _setup(self, anchor: AnchoredTo) -> Setup:
        return Setup(
            camera=self.theatre.camera,
            camera_calibrated=True,
            tools={},
            channel=Absent(reason=AbsentReason.NO_PLAN),
            registration=Absent(reason=AbsentReason.NOT_REGISTERED),
            reference="reference" if anchor is AnchoredTo.REFERENCE else "",
        )
