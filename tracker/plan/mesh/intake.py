"""Validation and clean-up of an imported mesh."""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np
import numpy.typing as npt

from tracker.errors import PlanError, Remark
from tracker.geometry import Array
from tracker.plan.mesh.remarks import Findings, remarks_of
from tracker.plan.mesh.units import MM_FROM_UNIT, FittingUnit, Kind, fitting_units, kind_of
from tracker.plan.surface import Surface
from tracker.plan.triangles import connectivity_of, referenced, wound_outwards
from tracker.plan.triangles.connectivity import Faces, areas_of, equal_rows, parts_of


class Space(StrEnum):
    """Axis convention of a file: LPS or RAS."""

    LPS = "LPS"
    RAS = "RAS"


@dataclass(frozen=True, slots=True, kw_only=True)
class MeshSurface:
    """An imported mesh, cleaned, with the findings about it.

    Attributes:
        surface: in LPS, in mm, wound outwards if the orientation can be determined.
        kind: a vertebra or several, by its size.
        unit: of the imported coordinates.
        unit_given: whether the user gave the unit; otherwise mm are plausible.
        space: axis convention of the imported coordinates.
        size_mm: (3,) size of the bounding box.
        parts: number of connected components.
        closed: whether the mesh is closed.
        flipped_faces: number of triangles whose winding was flipped.
        remarks: warnings for the user.
    """

    surface: Surface
    kind: Kind
    unit: str
    unit_given: bool
    space: Space
    size_mm: Array
    parts: int
    closed: bool
    flipped_faces: int
    remarks: tuple[Remark, ...]


def surface_from_mesh(
    vertices: npt.ArrayLike,
    faces: npt.ArrayLike,
    *,
    unit: str | None = None,
    space: Space = Space.LPS,
) -> MeshSurface:
    """Return the surface of a mesh; it is scaled only if its unit is given.

    Args:
        vertices: (n, 3) in the mesh's own unit.
        faces: (m, 3) indices.
        unit: a key of `MM_FROM_UNIT`; None accepts mm if the size is plausible.
        space: of its coordinates.

    Raises:
        PlanError: MESH_EMPTY, MESH_INVALID, MESH_UNIT_INVALID; MESH_UNIT_NEEDED, in mm its size is that of
            neither a vertebra nor several, and another unit is proposed; MESH_SIZE_IMPLAUSIBLE, the size is
            implausible in any unit, or in the given one.
    """
    points, corners = _checked(np.asarray(vertices, np.float64), np.asarray(faces, np.int64))
    points, corners, dropped = _cleaned(points, corners)
    kind = _kind(np.ptp(points, axis=0), unit)
    signs = np.array([-1.0, -1.0, 1.0]) if space is Space.RAS else np.ones(3)
    points = points * signs * MM_FROM_UNIT[unit or "mm"]
    connectivity = connectivity_of(corners)
    corners, flipped = wound_outwards(points, corners)
    parts, _ = parts_of(corners, points.shape[0])
    size_mm = np.ptp(points, axis=0)
    found = Findings(
        kind=kind, size_mm=size_mm, parts=parts, connectivity=connectivity, flipped=flipped,
        faces=int(corners.shape[0]), dropped=dropped, mirrored=space is Space.RAS,
    )  # fmt: skip
    return MeshSurface(
        surface=Surface(vertices_mm=points, faces=corners),
        kind=kind,
        unit=unit or "mm",
        unit_given=unit is not None,
        space=space,
        size_mm=size_mm,
        parts=parts,
        closed=connectivity.closed,
        flipped_faces=flipped,
        remarks=remarks_of(found),
    )


def _checked(points: Array, corners: Faces) -> tuple[Array, Faces]:
    """Validate shapes, values and indexes."""
    if points.size == 0 or corners.size == 0:
        raise PlanError(
            "MESH_EMPTY",
            f"the mesh has {points.size // 3} vertices and {corners.size // 3} triangles",
            "Export the bone's surface again as triangles in STL, OBJ or PLY.",
            {"vertices": points.size // 3, "faces": corners.size // 3},
        )
    problem = ""
    if points.ndim != 2 or points.shape[1] != 3 or corners.ndim != 2 or corners.shape[1] != 3:
        problem = f"its vertices have shape {points.shape} and its faces {corners.shape}"
    elif corners.min() < 0 or corners.max() >= points.shape[0]:
        wrong = int(corners.min()) if corners.min() < 0 else int(corners.max())
        problem = f"a face names vertex {wrong}, there are {points.shape[0]}"
    elif not np.isfinite(points[np.unique(corners)]).all():
        problem = "a coordinate is not finite"
    elif np.abs(points[np.unique(corners)]).max() > 1e9:
        problem = "a coordinate is above 1e9"
    if problem:
        raise PlanError(
            "MESH_INVALID",
            f"the mesh cannot be used: {problem}",
            "Export the bone's surface again as triangles in STL, OBJ or PLY.",
            {"mesh_problem": problem},
        )
    return points, corners


def _cleaned(points: Array, corners: Faces) -> tuple[Array, Faces, int]:
    """Merge equal vertices, remove degenerate and duplicate triangles, and count those removed."""
    before = int(corners.shape[0])
    points, corners = referenced(points, corners)
    first, renamed = equal_rows(points)
    unique, corners = points[first], renamed[corners]
    corners = corners[areas_of(unique, corners) > 1e-12 * float(np.ptp(unique, axis=0).max()) ** 2]
    first, _ = equal_rows(np.sort(corners, axis=1))
    corners = corners[np.sort(first)]
    if corners.shape[0] < 4:
        raise PlanError(
            "MESH_EMPTY",
            f"the mesh has {corners.shape[0]} triangles with an area, needed 4 or more",
            "Export the bone's surface again as triangles in STL, OBJ or PLY.",
            {"faces": before, "with_area": int(corners.shape[0])},
        )
    return *referenced(unique, corners), before - int(corners.shape[0])


def _kind(size: Array, unit: str | None) -> Kind:
    """Return the kind of the mesh by its size in the given unit, or in mm."""
    if unit is not None and unit not in MM_FROM_UNIT:
        units = ", ".join(MM_FROM_UNIT)
        raise PlanError(
            "MESH_UNIT_INVALID",
            f"'{unit}' is not a unit of a mesh",
            f"Give one of {units}.",
            {"unit": unit, "allowed": list(MM_FROM_UNIT), "units": units},
        )
    kind = kind_of(size * MM_FROM_UNIT[unit or "mm"])
    if kind is not None:
        return kind
    fits = fitting_units(size)
    units = "; ".join(_formatted(fit) for fit in fits)
    sides, tried = _sides(size), unit or "mm"
    raise PlanError(
        "MESH_UNIT_NEEDED" if fits and unit is None else "MESH_SIZE_IMPLAUSIBLE",
        f"the mesh is {sides} in its own units, which in {tried} is neither a vertebra nor several",
        f"Measure it and give its unit: {units}."
        if fits
        else "Its size is implausible in any unit: export one vertebra only, with its unit.",
        {
            "size": size.tolist(),
            "sides": sides,
            "unit": unit,
            "tried_unit": tried,
            "proposed_unit": fits[0].unit if fits else None,
            "possible_units": [fit.unit for fit in fits],
            "fitting_units": units,
        },
    )


def _formatted(fit: FittingUnit) -> str:
    return f"in {fit.unit} it is {_sides(fit.size_mm)} mm, the size of {_words(fit.kind)}"


def _words(kind: Kind) -> str:
    return "a vertebra" if kind is Kind.VERTEBRA else kind.value


def _sides(size: Array) -> str:
    return " x ".join(f"{side:.3g}" for side in size)
