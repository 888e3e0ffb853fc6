"""Rehearsal settings: scene, skill and difficulty."""

import math
from dataclasses import dataclass
from enum import StrEnum

from tracker.rehearsal.events import Event, rejected

HARDEST = 10.0
SIDE_PX = (160, 4096)
MIN_REST_S, MAX_REST_S = 0.5, 60.0


class Scene(StrEnum):
    """Rehearsed scene."""

    OPERATION = "operation"  # a drill goes into the pedicle, and wanders off
    PIVOT = "pivot"  # the drill's tip rests on the bone while it is tilted to all sides
    SPIN = "spin"  # the drill turns about its own axis
    BOARD = "board"  # a calibration board is shown to the camera in many places and tilts
    LANDMARKS = "landmarks"  # the tip rests on one named landmark of the bone after the other
    SWEEP = "sweep"  # the tip sweeps over the bone's surface
    CHECK = "check"  # the tip rests on a landmark that is not touched in the scene before


class Skill(StrEnum):
    """Drilling skill of the simulated hand."""

    WANDERING = "wandering"  # like a hand, then off by millimetres and degrees, then out of the image
    GOOD = "good"  # all the time along the channel's axis, within half a millimetre
    BREACHING = "breaching"  # through the pedicle's wall to the canal


class BoardKind(StrEnum):
    """Calibration board of the rehearsal."""

    DOTS = "dots"
    CHECKERBOARD = "checkerboard"
    CHARUCO = "charuco"
    APRILGRID = "aprilgrid"


@dataclass(frozen=True, slots=True, kw_only=True)
class TheatreSettings:
    """Theatre settings; difficulty 1.0 is a good camera in good light, 0 ideal, 10 very hard.

    Attributes:
        seed: determines everything random: same seed, same theatre.
        size_wh_px: width and height of the images.
        noise: shot and read noise of the sensor.
        blur: defocus and motion blur (1.0: sigma 0.6 px, exposure 8 ms).
        clutter: instruments, gauze, labels and, above 2, squares that look like markers.
        light: unevenness, dimness and flicker of the illumination.
        scene: the rehearsed scene.
        board: which calibration board is shown in its scene.
        skill: drilling skill in the operation.
        rest_s: dwell time of the tip on a landmark.
        reference: whether a second marker is fixed to the patient.
        events: scheduled disturbances.

    Raises:
        InvalidInput: REHEARSAL_SETTING_INVALID, with the key, its value and what is allowed.
    """

    seed: int = 1
    size_wh_px: tuple[int, int] = (1280, 720)
    noise: float = 1.0
    blur: float = 1.0
    clutter: float = 1.0
    light: float = 1.0
    scene: Scene = Scene.OPERATION
    board: BoardKind = BoardKind.DOTS
    skill: Skill = Skill.WANDERING
    rest_s: float = 3.0
    reference: bool = False
    events: tuple[Event, ...] = ()

    def __post_init__(self) -> None:
        if not 0 <= self.seed < 2**32:
            raise rejected("seed", self.seed, f"a whole number from 0 to {2**32 - 1}")
        if not all(SIDE_PX[0] <= side <= SIDE_PX[1] for side in self.size_wh_px):
            raise rejected("size_wh_px", self.size_wh_px, f"sides from {SIDE_PX[0]} to {SIDE_PX[1]} px")
        if not MIN_REST_S <= self.rest_s <= MAX_REST_S:
            raise rejected("rest_s", self.rest_s, f"seconds from {MIN_REST_S:g} to {MAX_REST_S:g}")
        for name in ("noise", "blur", "clutter", "light"):
            value = float(getattr(self, name))
            if not (math.isfinite(value) and 0.0 <= value <= HARDEST):
                raise rejected(name, value, f"a number from 0 (none) to {HARDEST:g} (very hard)")
