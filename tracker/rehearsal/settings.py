"""How hard the rehearsal is."""

import math
from dataclasses import dataclass
from enum import StrEnum

from tracker.errors import InvalidInput

HARDEST = 10.0
SIDE_PX = (160, 4096)


class Scene(StrEnum):
    """What is rehearsed."""

    OPERATION = "operation"  # a drill goes into the pedicle, and wanders off
    PIVOT = "pivot"  # the drill's tip rests on the bone while it is tilted to all sides
    SPIN = "spin"  # the drill turns about its own axis
    BOARD = "board"  # a calibration board is shown to the camera in many places and tilts


class BoardKind(StrEnum):
    """Which calibration board is rehearsed with."""

    DOTS = "dots"
    CHECKERBOARD = "checkerboard"
    CHARUCO = "charuco"


@dataclass(frozen=True, slots=True, kw_only=True)
class TheatreSettings:
    """What kind of theatre is played: 1.0 is a good camera in good light, 0 none of it, 10 very hard.

    Attributes:
        seed: everything that is random follows from it: same seed, same theatre.
        size_wh_px: width and height of the images.
        noise: shot and read noise of the sensor.
        blur: defocus and motion blur (1.0: sigma 0.6 px, exposure 8 ms).
        clutter: instruments, gauze, labels and, above 2, squares that look like markers.
        light: how uneven, dim and unsteady the light is.
        scene: what is rehearsed.
        board: which calibration board is shown in its scene.

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

    def __post_init__(self) -> None:
        if not 0 <= self.seed < 2**32:
            raise _refused("seed", self.seed, f"a whole number from 0 to {2**32 - 1}")
        if not all(SIDE_PX[0] <= side <= SIDE_PX[1] for side in self.size_wh_px):
            raise _refused("size_wh_px", self.size_wh_px, f"sides from {SIDE_PX[0]} to {SIDE_PX[1]} px")
        for name in ("noise", "blur", "clutter", "light"):
            value = float(getattr(self, name))
            if not (math.isfinite(value) and 0.0 <= value <= HARDEST):
                raise _refused(name, value, f"a number from 0 (none) to {HARDEST:g} (very hard)")


def _refused(key: str, value: object, allowed: str) -> InvalidInput:
    return InvalidInput(
        "REHEARSAL_SETTING_INVALID",
        f"the rehearsal's {key} is {value}, allowed is {allowed}",
        f"Set {key} to {allowed}.",
        {"key": key, "value": value},
    )
