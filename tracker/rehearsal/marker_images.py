"""Images of the printed markers: asymmetric shapes in black squares, original to this project."""

import cv2
import numpy as np
import numpy.typing as npt

# In sides of the square, x right and y down. A white boot with a black disc in its heel, and a white bar
# across from its shin: edges of both polarities, nothing thinner than a tenth of the side (3 px at 30 px),
# and no rotation or reflection maps it to itself.
BOOT = ((0.17, 0.17), (0.59, 0.17), (0.59, 0.41), (0.83, 0.65), (0.83, 0.83), (0.17, 0.83))
BAR = ((0.71, 0.17), (0.83, 0.17), (0.83, 0.41), (0.71, 0.41))
DISC_CENTRE, DISC_RADIUS = (0.38, 0.60), 0.125
# The reference's: a white comb with three unequal teeth, and a white wedge above them.
COMB = (
    *((0.16, 0.84), (0.16, 0.64), (0.30, 0.44), (0.30, 0.64), (0.43, 0.64), (0.43, 0.50), (0.56, 0.50)),
    *((0.56, 0.64), (0.70, 0.64), (0.70, 0.28), (0.84, 0.28), (0.84, 0.84)),
)
WEDGE = ((0.16, 0.16), (0.56, 0.16), (0.56, 0.32), (0.16, 0.32))
SHIFT_BITS = 4
SUPERSAMPLING = 4


def drill_marker_image(side_px: int = 400) -> npt.NDArray[np.uint8]:
    """Return the printed face (side_px, side_px), black 0, white 255; the square fills the image."""
    fine_px = side_px * SUPERSAMPLING
    image = np.zeros((fine_px, fine_px), dtype=np.uint8)
    for shape in (BOOT, BAR):
        cv2.fillPoly(image, [_fixed(shape, fine_px)], 255, lineType=cv2.LINE_8, shift=SHIFT_BITS)
    centre = _fixed((DISC_CENTRE,), fine_px)[0]
    radius = round(DISC_RADIUS * fine_px * 2**SHIFT_BITS)
    cv2.circle(image, (int(centre[0]), int(centre[1])), radius, 0, -1, cv2.LINE_8, SHIFT_BITS)
    return _shrunk(image, side_px)


def reference_marker_image(side_px: int = 400) -> npt.NDArray[np.uint8]:
    """Return the reference's printed face, as `drill_marker_image`."""
    fine_px = side_px * SUPERSAMPLING
    image = np.zeros((fine_px, fine_px), dtype=np.uint8)
    for shape in (COMB, WEDGE):
        cv2.fillPoly(image, [_fixed(shape, fine_px)], 255, lineType=cv2.LINE_8, shift=SHIFT_BITS)
    return _shrunk(image, side_px)


def _shrunk(image: npt.NDArray[np.uint8], side_px: int) -> npt.NDArray[np.uint8]:
    small = cv2.resize(image, (side_px, side_px), interpolation=cv2.INTER_AREA)
    return np.asarray(small, dtype=np.uint8)


def _fixed(points: tuple[tuple[float, float], ...], side_px: int) -> npt.NDArray[np.int32]:
    """Convert points in sides to fixed-point pixels; the square's edge lies half a pixel outside 0."""
    px = np.asarray(points, dtype=np.float64) * side_px - 0.5
    return np.asarray(np.rint(px * 2**SHIFT_BITS), dtype=np.int32)
