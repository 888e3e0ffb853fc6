"""The detected points of a board in one image, or the reason why it was not found."""

from dataclasses import dataclass, field
from enum import StrEnum

import numpy as np
import numpy.typing as npt

from tracker.errors import InvalidInput
from tracker.geometry import Array


class NotFoundReason(StrEnum):
    """Reason why a board was not found in an image."""

    NO_POINTS = "no_points"
    """Nothing in the image looks like a dot, a corner or a marker of the board."""
    TOO_FEW_POINTS = "too_few_points"
    """Some was seen, and not enough of it hangs together."""
    OTHER_SIZE = "other_size"
    """A regular grid is there, and has more columns or rows than the board."""
    OTHER_FIDUCIALS = "other_fiducials"
    """The larger dots stand where the board has none."""


class PlacementAmbiguity(StrEnum):
    """Ambiguity of which point of the board each seen point is.

    A half turn of the board does not affect the calibration of one camera; between two cameras it does.
    """

    NONE = "none"
    HALF_TURN = "half_turn"
    """The board rotated about its centre by 180 degrees (a square one by 90) looks the same."""
    PLACE = "place"
    """Only a part was seen, which may be any part of the board."""


@dataclass(frozen=True, slots=True, kw_only=True)
class BoardNotFound:
    """No board in this image.

    Attributes:
        reason: the reason as a code.
        sentence: the reason as text with numbers, without a full stop.
        seen_points: number of points in the largest grid.
    """

    reason: NotFoundReason
    sentence: str
    seen_points: int = 0


@dataclass(frozen=True, slots=True, kw_only=True)
class BoardView:
    """Points of a board in one image.

    Attributes:
        ids: (n,) which points of the board, ascending, each once.
        object_points_mm: (n, 3), their positions on the board.
        image_points_px: (n, 2), their positions in the image.
        dot_radii_mm: (n,), radii of the dots; (0,) if points are corners.
        ambiguity: of the ids.

    Raises:
        InvalidInput: VIEW_INVALID, shapes do not agree or a number is not finite.
    """

    ids: npt.NDArray[np.int64]
    object_points_mm: Array
    image_points_px: Array
    dot_radii_mm: Array = field(default_factory=lambda: np.zeros(0))
    ambiguity: PlacementAmbiguity = PlacementAmbiguity.NONE

    def __post_init__(self) -> None:
        ids = np.array(self.ids, dtype=np.int64).ravel()
        points = np.array(self.object_points_mm, dtype=np.float64)
        px = np.array(self.image_points_px, dtype=np.float64)
        radii = np.array(self.dot_radii_mm, dtype=np.float64).ravel()
        fits = points.shape == (ids.size, 3) and px.shape == (ids.size, 2) and radii.size in (0, ids.size)
        finite = fits and all(np.isfinite(one).all() for one in (points, px, radii))
        if not finite or np.unique(ids).size != ids.size:
            raise InvalidInput(
                "VIEW_INVALID",
                f"a view of a board has {ids.size} ids, object points of shape {points.shape} and image "
                f"points of shape {px.shape}, needed (n,), (n, 3), (n, 2), finite, each id once",
                "Detect the board again in its image.",
                {"ids": ids.size, "object_shape": str(points.shape), "image_shape": str(px.shape)},
            )
        order = np.argsort(ids)
        radii = radii[order] if radii.size else radii
        for name, value in (
            ("ids", ids[order]),
            ("object_points_mm", points[order]),
            ("image_points_px", px[order]),
            ("dot_radii_mm", radii),
        ):
            value.setflags(write=False)
            object.__setattr__(self, name, value)

    def part(self, retained: npt.NDArray[np.bool_]) -> "BoardView":
        """Return the view with some of its points."""
        return BoardView(
            ids=self.ids[retained],
            object_points_mm=self.object_points_mm[retained],
            image_points_px=self.image_points_px[retained],
            dot_radii_mm=self.dot_radii_mm[retained] if self.dot_radii_mm.size else self.dot_radii_mm,
            ambiguity=self.ambiguity,
        )
