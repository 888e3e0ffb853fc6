"""A model laid over a square: where it is, how it is blurred and lit, and what that leaves."""

from dataclasses import dataclass
from functools import cache

import numpy as np
import numpy.typing as npt

from tracker.edges import GreyImage
from tracker.geometry import Array
from tracker.marker.explanation.cover import Left, Mask
from tracker.marker.explanation.fields.kernels import (
    FIELDS,
    RING,
    WIDE,
    fields_ahead,
    lens_blur,
    picture_at,
    sample_fields,
)
from tracker.marker.explanation.kernels import BLUR, PLACE, SATURATED_GREY, clear_of_beyond, walk
from tracker.marker.explanation.light import contrasts, grid, smooth_light
from tracker.marker.explanation.pictures import Pictures
from tracker.marker.sampling.kernels import even_light, square_to_quad

# Blur to begin with: a camera in focus, its pixel, the sampling between pixels.
FIRST_BLUR_PX, WIDE_BLUR_SIDES = 0.8, 0.05
MIN_SIDE_PX = 8.0
# Light without highlights has a quadratic and a step.
MAX_SMOOTH_TERMS = 7
# What is compared with what is around it: a sixth of a side away sees the border and the paper at once.
AROUND_FIELDS, PICTURE_GREY = 4, 100.0
SQUARE = np.s_[RING:-RING, RING:-RING]
MIN_SD_GREY, MIN_SD_RATIO = 6.0, 0.1
UNIT = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])


@dataclass(frozen=True, slots=True, kw_only=True)
class Place:
    """Where a fit is.

    Attributes:
        corners: (4, 2) in the unit square.
        blur: (3,), variances along u, v and between, in fields.
        held: (WIDE, WIDE), the contrast by which the pictures' changes are counted.
        seen: (WIDE, WIDE) there, and `shown` (6, WIDE, WIDE), the picture with its slopes and curvatures.
    """

    corners: Array
    blur: Array
    held: Array
    seen: Array
    shown: npt.NDArray[np.float32]


class Fit:
    """A model laid over a square. Mutable: it walks."""

    def __init__(self, image: GreyImage, pictures: Pictures, corners_px: Array, side_px: float) -> None:
        self.image, self.pictures = image, pictures
        self.side_px = side_px
        self.field_px = field_px_of(side_px)
        self.to_px = np.empty(8)
        square_to_quad(np.ascontiguousarray(corners_px, dtype=np.float64), self.to_px)
        self.corners: Array = UNIT.copy()
        self.blur: Array = np.zeros(3)
        self.held: Array = np.ones((WIDE, WIDE))
        self.visible: Mask = np.ones((WIDE, WIDE), np.bool_)
        self.light: Array = smooth_light(2)
        self.gains: Array = contrasts()
        self.shown: npt.NDArray[np.float32] = np.empty((6, WIDE, WIDE), np.float32)
        self.seen: Array = np.empty((WIDE, WIDE))
        self.rest: Array = np.empty((WIDE, WIDE))
        self.gain: Array = np.empty((WIDE, WIDE))

    def walk(self, rounds: int, weight: Array | None = None, *, free: int = PLACE + BLUR) -> bool:
        """Fit place, blur and light; False where the model has no contrast."""
        self.weight = np.ones((WIDE, WIDE)) if weight is None else weight
        contrast = walk(
            self.image,
            self.to_px,
            self.pictures.layers,
            self.pictures.blurs_fields,
            self.corners,
            self.blur,
            self.held,
            self.visible,
            self.weight,
            self.light,
            self.gains,
            self.field_px,
            rounds,
            free,
            self.seen,
            self.shown,
            self.rest,
            self.gain,
        )
        return bool(contrast > 0.0)

    def look(self, blur_px: float = FIRST_BLUR_PX) -> None:
        """See what is there, before anything is fitted, and the model out of focus by so much."""
        self.blur, ahead = np.empty(3), self.ahead
        lens_blur(ahead, blur_px, self.blur)
        self.seen = sample_fields(self.image, self.to_px, self.corners)
        picture_at(self.pictures.layers, self.pictures.blurs_fields, self.blur, ahead, self.shown)

    @property
    def is_under_highlights(self) -> bool:
        """Whether highlights are a part of its light."""
        return bool(self.light.shape[1] > MAX_SMOOTH_TERMS)

    @property
    def ahead(self) -> Array:
        """By how many fields (2, 2) a pixel's step right and down goes."""
        ahead = np.empty((2, 2))
        fields_ahead(self.to_px, self.corners, ahead)
        return ahead

    @property
    def place(self) -> Place:
        """Where the walk is, and what it sees there; to be set, too, where all is visible again."""
        return Place(
            corners=self.corners.copy(),
            blur=self.blur.copy(),
            held=self.held.copy(),
            seen=self.seen.copy(),
            shown=self.shown.copy(),
        )

    @place.setter
    def place(self, place: Place) -> None:
        self.corners, self.blur, self.held = place.corners.copy(), place.blur.copy(), place.held.copy()
        self.seen, self.shown = place.seen.copy(), place.shown.copy()
        self.visible = np.ones((WIDE, WIDE), np.bool_)

    @property
    def picture(self) -> npt.NDArray[np.float32]:
        """The model as it is fitted, dark 0 to bright 1."""
        return np.asarray(self.shown[0])

    def look_part_by_part(self) -> float:
        """See what is there, and how like the model it is where each field is judged beside those around it.

        A shadow, glare or a cover over a part of it leaves the rest as it is. Of two blurs the likelier one
        stays. Returns the correlation, -1..1.
        """
        best, of_best = -1.0, np.zeros(3)
        for blur_px in (FIRST_BLUR_PX, WIDE_BLUR_SIDES * self.side_px):
            self.look(blur_px)
            both = np.stack([self.seen[SQUARE], PICTURE_GREY * self.picture[SQUARE]])
            flat = both.reshape(2, -1).astype(np.float32)
            even_light(flat, FIELDS, AROUND_FIELDS, MIN_SD_GREY, MIN_SD_RATIO)
            alike = float(flat[0] @ flat[1])
            if alike > best:
                best, of_best = alike, self.blur
        self.blur = of_best
        return best

    def telling(self, visible: Mask) -> Mask:
        """Which visible fields tell: not too bright, and clear of what blur brings in beyond the paper."""
        clear = np.empty((WIDE, WIDE), np.bool_)
        clear_of_beyond(self.blur, clear)
        return np.asarray(visible & (self.seen < SATURATED_GREY) & clear)

    @property
    def blur_fields(self) -> float:
        """Sd of the blur, as it is on average over all directions."""
        return float(np.sqrt(0.5 * (self.blur[0] + self.blur[1])))

    @property
    def left(self) -> Left:
        """What the fit leaves."""
        return Left(seen=self.seen, picture=self.picture, rest=self.rest, gain=self.gain)


def correlation_part_by_part(
    image: GreyImage, pictures: Pictures, corners_px: Array, *, side_px: float
) -> float:
    """How like a marker what an image shows at these corners (4, 2) is, part by part, -1..1.

    In shadow, glare and noise it tells more than a glance, and less where motion smears.
    """
    return Fit(image, pictures, corners_px, side_px).look_part_by_part()


def field_px_of(side_px: float) -> float:
    """How wide a field of a square is, in px."""
    return max(side_px, MIN_SIDE_PX) / FIELDS


@cache
def inside_square() -> Mask:
    """Which fields lie inside the outline."""
    u, v = grid()
    return np.asarray(np.maximum(np.abs(u), np.abs(v)) < 1.0)
