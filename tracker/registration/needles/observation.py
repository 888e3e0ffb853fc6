"""A needle as observed in the image."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.errors import InvalidInput
from tracker.geometry import Array

SHORTEST_PX = 8.0
# Length of a needle that bone occludes at its entry: mean and sd for needles in the posterior elements, seen
# from 30 to 65 degrees above the table.
OCCLUDED_MM, OCCLUDED_SD_MM = 3.0, 4.0


@dataclass(frozen=True, slots=True, kw_only=True)
class NeedleObservation:
    """Centre line of a needle in the image, from its exit from the bone to its head.

    Attributes:
        entry_px: (2,), its exit from the bone, or the visible end if bone occludes that.
        head_px: (2,), the far end.
        across_sd_px: standard deviation across the line, at either end.
        along_sd_px: standard deviation of the end at the bone, along the line.
        entry_is_seen: whether `entry_px` is the entry itself, and not an end that bone occludes.
        width_px: of the wire; 0 if not measured.

    Raises:
        InvalidInput: NEEDLE_SEEN_INVALID, a number is not finite, a standard deviation is not positive, or it
            is short.
    """

    entry_px: Array
    head_px: Array
    across_sd_px: float
    along_sd_px: float
    entry_is_seen: bool = False
    width_px: float = 0.0

    def __post_init__(self) -> None:
        for name in ("entry_px", "head_px"):
            point = np.array(getattr(self, name), dtype=np.float64).reshape(2)
            point.setflags(write=False)
            object.__setattr__(self, name, point)
        ends = np.stack([self.entry_px, self.head_px])
        spreads = np.array([self.across_sd_px, self.along_sd_px])
        if (
            not (np.isfinite(ends).all() and np.isfinite(spreads).all())
            or spreads.min() <= 0.0
            or self.length_px < SHORTEST_PX
        ):
            raise InvalidInput(
                "NEEDLE_SEEN_INVALID",
                f"a needle is {self.length_px:.1f} px long with a spread of {spreads.min():g} px; "
                f"needed at least {SHORTEST_PX:g} px and a spread above 0",
                "Mark the needle's exit from the bone, and its head.",
                {
                    "length_px": self.length_px,
                    "spread_px": float(spreads.min()),
                    "min_length_px": SHORTEST_PX,
                },
            )

    @property
    def length_px(self) -> float:
        """From the bone to the head."""
        return float(np.linalg.norm(self.head_px - self.entry_px))


def needle_from_clicks(
    entry_px: npt.ArrayLike, head_px: npt.ArrayLike, *, sd_px: float = 1.0, entry_is_seen: bool = True
) -> NeedleObservation:
    """Return a needle marked by a person: its exit from the bone, then its head.

    Args:
        entry_px: (2,), in the image.
        head_px: (2,), in the image.
        sd_px: accuracy of a click, along each axis.
        entry_is_seen: whether the entry into the bone is visible; otherwise only the line is used.
    """
    return NeedleObservation(
        entry_px=np.asarray(entry_px, dtype=np.float64),
        head_px=np.asarray(head_px, dtype=np.float64),
        across_sd_px=sd_px,
        along_sd_px=sd_px,
        entry_is_seen=entry_is_seen,
    )
