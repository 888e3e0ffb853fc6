"""Import of a surface mesh: size, unit, orientation and completeness checks."""

from tracker.plan.mesh.intake import MeshSurface, surface_from_mesh
from tracker.plan.mesh.units import MM_FROM_UNIT, FittingUnit, fitting_units

__all__ = ["MM_FROM_UNIT", "FittingUnit", "MeshSurface", "fitting_units", "surface_from_mesh"]
