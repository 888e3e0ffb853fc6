"""The surface of a bone."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.geometry import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Surface:
    """A closed mesh of triangles in the vertebra's frame.

    Attributes:
        vertices_mm: (n, 3), LPS.
        faces: (m, 3), indices of vertices, counter-clockwise seen from outside.
    """

    vertices_mm: Array
    faces: npt.NDArray[np.int64]
