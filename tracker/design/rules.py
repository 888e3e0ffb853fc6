"""Design rules that keep a shape recognisable when it is 25 px wide and blurred."""

import cv2
import numpy as np
import numpy.typing as npt

from tracker.design.shape import Shape, rasterised

# At 25 px in the image, an eighth of the side is 3 px: blur removes the contrast of thinner parts.
MIN_PART_RATIO = 1 / 8
RASTER_PX = 96
PAPER_PX = 16
# Area that an opening with a disc removes from a corner of 60 degrees, in squares of its radius. A larger
# area is a spike or a thin part.
MAX_CORNER_REST = 0.85
# Blur removes a shorter edge: a notch or a step.
MIN_EDGE_RATIO = 0.11
# White ratio of the face. A marker with little of either colour has too few edges.
WHITE_SHARE = (0.2, 0.55)
# Shares of the inner edges in four sectors of direction (45 degrees each); 0.25 for a uniform distribution.
# Motion blur along a direction leaves only the edges along it: each direction needs some.
SECTORS = 4
MIN_SECTOR_SHARE = 0.12


def satisfies_rules(shape: Shape) -> bool:
    """Return whether all parts are thick enough, black and white balanced and edge directions spread."""
    if not has_long_edges(shape) or min(sector_shares(shape)) < MIN_SECTOR_SHARE:
        return False
    image = rasterised(shape, RASTER_PX)
    if not WHITE_SHARE[0] <= float((image > 0).mean()) <= WHITE_SHARE[1]:
        return False
    paper = cv2.copyMakeBorder(image, *(PAPER_PX,) * 4, cv2.BORDER_CONSTANT, value=(255,))
    return is_thick(image > 0) and is_thick(np.asarray(paper, dtype=np.uint8) == 0)


def has_long_edges(shape: Shape) -> bool:
    """Return whether every polygon edge is at least `MIN_EDGE_RATIO` long."""
    for patch in shape.patches:
        edges = np.linalg.norm(np.roll(patch.corners, -1, axis=0) - patch.corners, axis=1)
        if len(edges) < 3 or float(edges.min()) < MIN_EDGE_RATIO:
            return False
    return bool(shape.patches)


def is_thick(mask: npt.NDArray[np.bool_]) -> bool:
    """Return whether an opening with a disc of the minimum thickness keeps all of a mask but its corners."""
    width = round(MIN_PART_RATIO * RASTER_PX)
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (width + 1, width + 1))
    # Padded with background: the picture border must not count as thickness.
    whole = np.pad(mask.astype(np.uint8), width)
    rest = whole & ~np.asarray(cv2.morphologyEx(whole, cv2.MORPH_OPEN, disc), np.uint8)
    count, _, stats, _ = cv2.connectedComponentsWithStats(rest, connectivity=4)
    largest = max((int(stats[k, cv2.CC_STAT_AREA]) for k in range(1, count)), default=0)
    return largest <= MAX_CORNER_REST * (width / 2.0) ** 2


def sector_shares(shape: Shape) -> list[float]:
    """Return the share of inner edge length by direction: around 0, 45, 90 and 135 degrees."""
    steps = np.concatenate(
        [np.roll(patch.corners, -1, axis=0) - patch.corners for patch in shape.patches]
    ).reshape(-1, 2)
    length = np.hypot(steps[:, 0], steps[:, 1])
    sector = np.rint(np.degrees(np.arctan2(steps[:, 1], steps[:, 0])) / (180.0 / SECTORS)).astype(int)
    total = max(float(length.sum()), 1e-9)
    return [float(length[sector % SECTORS == one].sum()) / total for one in range(SECTORS)]
