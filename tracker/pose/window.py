"""The region of interest around an expected marker."""

from math import ceil, floor

from tracker.geometry import Array
from tracker.pose.occurrence import side_px_of

MARGIN_PX, MARGIN_SIDE_RATIO, MIN_PX = 8.0, 0.15, 24


# Left, top, right, bottom [px]; right and bottom are exclusive.
Window = tuple[int, int, int, int]


def window_around(corners_px: Array, *, reach_px: float, size_wh_px: tuple[int, int]) -> Window | None:
    """Return left, top, right, bottom (px) of the region that can contain a marker expected at these corners.

    Returns None where too little of it lies inside the image.
    """
    margin = reach_px + MARGIN_PX + MARGIN_SIDE_RATIO * side_px_of(corners_px)
    width, height = size_wh_px
    across, down = corners_px.T.tolist()
    left, top = max(floor(min(across) - margin), 0), max(floor(min(down) - margin), 0)
    right, bottom = min(ceil(max(across) + margin), width), min(ceil(max(down) + margin), height)
    if right - left < MIN_PX or bottom - top < MIN_PX:
        return None
    return left, top, right, bottom
