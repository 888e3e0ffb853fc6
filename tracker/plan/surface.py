"""Triangle mesh of the bone surface."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.errors import PlanError
from tracker.geometry import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Surface:
    """A triangle mesh in the vertebra's frame.

    Attributes:
        vertices_mm: (n, 3), LPS, in mm.
        faces: (m, 3) indices into the vertices; counter-clockwise seen from outside.

    Raises:
        PlanError: SURFACE_INVALID, a shape is wrong, a number is not finite, or a face names a vertex that
            is not there.
    """

    vertices_mm: Array
    faces: npt.NDArray[np.int64]

    def __post_init__(self) -> None:
        vertices = np.array(self.vertices_mm, dtype=np.float64)
        faces = np.array(self.faces, dtype=np.int64)
        problem = _problem(vertices, faces)
        if problem:
            raise PlanError(
                "SURFACE_INVALID",
                f"the surface cannot be used: {problem}",
                "Export the surface again as triangles, in mm of the patient's coordinates.",
                {
                    "vertices": int(vertices.shape[0]),
                    "faces": int(faces.shape[0]),
                    "mesh_problem": problem,
                },
            )
        vertices.setflags(write=False)
        faces.setflags(write=False)
        object.__setattr__(self, "vertices_mm", vertices)
        object.__setattr__(self, "faces", faces)

    @property
    def volume_ml(self) -> float:
        """Return the enclosed volume; valid only for a closed mesh. Negative for inward winding."""
        a, b, c = (self.vertices_mm[self.faces[:, i]] for i in range(3))
        return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6000.0)


def _problem(vertices: Array, faces: npt.NDArray[np.int64]) -> str:
    """Return the defect of this mesh, or an empty string."""
    if vertices.ndim != 2 or vertices.shape[1] != 3 or vertices.shape[0] < 3:
        return f"its vertices have shape {vertices.shape}, needed (n, 3)"
    if faces.ndim != 2 or faces.shape[1] != 3 or faces.shape[0] < 1:
        return f"its faces have shape {faces.shape}, needed (m, 3)"
    if not np.isfinite(vertices).all():
        return "a coordinate is not finite"
    if faces.min() < 0 or faces.max() >= vertices.shape[0]:
        return f"a face names vertex {int(faces.max())}, there are {vertices.shape[0]}"
    return ""
