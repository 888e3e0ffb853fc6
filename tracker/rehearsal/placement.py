"""Poses of camera, room and patient, and their changes by events."""

from dataclasses import dataclass, field

import numpy as np

from tracker.geometry import Array, Camera, Rigid, Vertebra
from tracker.rehearsal.events import Event, EventKind
from tracker.rehearsal.settings import TheatreSettings


class Room:
    """Frame of the static scene; equal to the vertebra's frame before any motion."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Placement:
    """Poses of camera and patient.

    Attributes:
        camera_from_room: the camera.
        room_from_vertebra: the patient.
        camera_from_vertebra: the patient as the camera sees them: the true registration to the camera.
    """

    camera_from_room: Rigid[Camera, Room]
    room_from_vertebra: Rigid[Room, Vertebra]
    camera_from_vertebra: Rigid[Camera, Vertebra] = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "camera_from_vertebra", self.camera_from_room @ self.room_from_vertebra)

    @property
    def key(self) -> bytes:
        """Return a key that is equal for bitwise equal placements."""
        return self.camera_from_room.matrix.tobytes() + self.room_from_vertebra.matrix.tobytes()


class Moves:
    """Motion events, with directions derived from the seed."""

    def __init__(self, settings: TheatreSettings, camera_from_vertebra: Rigid[Camera, Vertebra]) -> None:
        self._at_rest = Placement(
            camera_from_room=Rigid(
                rotation=camera_from_vertebra.rotation, translation_mm=camera_from_vertebra.translation_mm
            ),
            room_from_vertebra=Rigid.identity(),
        )
        self._moves = tuple(
            (event, *_ways(settings.seed, index, event.kind)) for index, event in enumerate(settings.events)
        )

    @property
    def at_rest(self) -> Placement:
        """Return the placement before any motion."""
        return self._at_rest

    def placement_at(self, at_s: float) -> Placement:
        """Return the placement at this time."""
        camera, room = self._at_rest.camera_from_room, self._at_rest.room_from_vertebra
        for event, shift, turn in self._moves:
            if event.kind is EventKind.CAMERA_MOVES and event.is_on(at_s):
                turned: Rigid[Room, Room] = _about(event, shift, turn)
                camera = camera @ turned
            if event.kind is EventKind.PATIENT_MOVES and event.is_on(at_s):
                moved: Rigid[Room, Room] = _about(event, shift, turn)
                room = moved @ room
        if camera is self._at_rest.camera_from_room and room is self._at_rest.room_from_vertebra:
            return self._at_rest
        return Placement(camera_from_room=camera, room_from_vertebra=room)

    def jump_mm_at(self, at_s: float) -> Array:
        """Return the drill's displacement (3,) from the hand, along the drill's axes."""
        out = np.zeros(3)
        for event, shift, _ in self._moves:
            if event.kind is EventKind.DRILL_JUMPS and event.is_on(at_s):
                out += event.size_mm * shift
        return out

    def placements(self) -> list[Placement]:
        """Return all possible placements, one for each set of simultaneous moves."""
        edges = {0.0}
        for event, _, _ in self._moves:
            if event.kind in (EventKind.CAMERA_MOVES, EventKind.PATIENT_MOVES):
                edges |= {event.at_s, event.over_at_s(event.at_s)}
        found = {p.key: p for p in (self.placement_at(at_s) for at_s in sorted(edges) if np.isfinite(at_s))}
        return list(found.values())


def _ways(seed: int, index: int, kind: EventKind) -> tuple[Array, Array]:
    """Return unit directions of a shift and of a rotation axis."""
    ways = np.random.default_rng([seed, 0x4D4F5645, index]).normal(0.0, 1.0, (2, 3))
    if kind is EventKind.PATIENT_MOVES:
        # A patient slides on the table, with hardly any vertical motion.
        ways[0, 1] = 0.1 * abs(ways[0, 1])
    shift, turn = ways / np.linalg.norm(ways, axis=1, keepdims=True)
    return shift, turn


def _about(event: Event, shift: Array, turn: Array) -> Rigid[Room, Room]:
    return Rigid.from_vector(np.radians(event.size_deg) * turn, event.size_mm * shift)
