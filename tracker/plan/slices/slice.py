"""One slice: Hounsfield units and the LPS position of each pixel."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.geometry import Array

# Letters of the positive and negative directions of the three LPS axes.
LETTERS = (("L", "R"), ("P", "A"), ("H", "F"))
# A second letter is added above this component (22.5 degrees).
SECOND_LETTER = 0.38


@dataclass(frozen=True, slots=True, kw_only=True)
class Edges:
    """Anatomical direction of each image edge: L, R, A, P, H, F; two letters for oblique directions."""

    left: str
    right: str
    top: str
    bottom: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Slice:
    """A plane through the CT, with u to the right and v down.

    Attributes:
        hu: (rows, columns) int16, read-only; -1024 beyond the scanned block.
        lps_from_px: (3, 3), takes (u, v, 1) to LPS in mm; the centre of the top-left pixel is (0, 0).
    """

    hu: npt.NDArray[np.int16]
    lps_from_px: Array

    def __post_init__(self) -> None:
        image = self.hu.view()
        image.setflags(write=False)
        object.__setattr__(self, "hu", image)
        affine = np.array(self.lps_from_px, dtype=np.float64)
        affine.setflags(write=False)
        object.__setattr__(self, "lps_from_px", affine)

    @property
    def size_wh_px(self) -> tuple[int, int]:
        """Return columns and rows."""
        rows, columns = self.hu.shape
        return columns, rows

    @property
    def pixel_mm(self) -> Array:
        """Return the distances (2,) between columns and between rows; native pixels may be anisotropic."""
        return np.asarray(np.linalg.norm(self.lps_from_px[:, :2], axis=0))

    @property
    def normal_lps(self) -> Array:
        """Return the unit viewing direction (3,), away from the viewer."""
        normal = np.cross(self.lps_from_px[:, 0], self.lps_from_px[:, 1])
        return np.asarray(normal / np.linalg.norm(normal))

    @property
    def edges(self) -> Edges:
        """Return the anatomical direction of each image edge."""
        right, down = (self.lps_from_px[:, i] / self.pixel_mm[i] for i in (0, 1))
        return Edges(left=_letters(-right), right=_letters(right), top=_letters(-down), bottom=_letters(down))

    def lps_from_pixel(self, pixels_px: npt.ArrayLike) -> Array:
        """Return points (..., 3) in LPS mm of pixels (..., 2) as u, v; fractions are allowed."""
        pixels = np.asarray(pixels_px, dtype=np.float64)
        return np.asarray(pixels @ self.lps_from_px[:, :2].T + self.lps_from_px[:, 2])

    def pixel_from_lps(self, points_lps_mm: npt.ArrayLike) -> Array:
        """Return pixels (..., 2) as u, v of points (..., 3) in LPS mm, projected onto the plane."""
        points = np.asarray(points_lps_mm, dtype=np.float64) - self.lps_from_px[:, 2]
        return np.asarray(points @ np.linalg.pinv(self.lps_from_px[:, :2]).T)

    def beyond_mm(self, points_lps_mm: npt.ArrayLike) -> Array:
        """Return the signed distance (...) of points (..., 3) behind the plane; negative in front of it."""
        points = np.asarray(points_lps_mm, dtype=np.float64) - self.lps_from_px[:, 2]
        return np.asarray(points @ self.normal_lps)


def _letters(direction: Array) -> str:
    """Return L, R, A, P, H or F, or two of them, the dominant first."""
    order = np.argsort(-np.abs(direction), kind="stable")
    named = [axis for rank, axis in enumerate(order) if rank == 0 or abs(direction[axis]) > SECOND_LETTER]
    return "".join(LETTERS[axis][0 if direction[axis] > 0.0 else 1] for axis in named[:2])
