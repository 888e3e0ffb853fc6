"""A vertebra of simple solids with exactly known pedicles, as a field of Hounsfield units."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from tracker.geometry import Array
from tracker.rehearsal.ct.distance_fields import Block, ContrastTube, Drum, EllipticTube, Part, Rod

NOWHERE_MM = 1e3
TOUCH_MM = 0.1


@dataclass(frozen=True, slots=True, kw_only=True)
class PedicleTruth:
    """Ground truth of one pedicle, in LPS; angles as in `PedicleMeasure`."""

    width_mm: float
    height_mm: float
    isthmus_lps_mm: Array
    axis_lps: Array
    length_mm: float


@dataclass(frozen=True, slots=True, kw_only=True)
class VertebraPhantom:
    """Body, arch, processes and two pedicles with a cortical shell and a marrow core.

    The solids are defined in the phantom's frame (LPS-like, origin in the canal); `rotation` and `place_mm`
    place it in the patient.

    Attributes:
        pedicles: by side, `left` and `right`.
        bones: everything else of the vertebra.
        neighbours: other bones, each with its own shell.
        beside: solids of constant HU: contrast, metal, lung.
        cortex_mm: thickness of the shell.
        cortex_hu: HU of the shell.
        marrow_hu: HU of the core.
        tissue_hu: HU of everything around.
        rotation: (3, 3), turns the phantom in the patient.
        place_mm: (3,), position of the canal.
    """

    pedicles: Mapping[str, EllipticTube]
    bones: tuple[Part, ...]
    neighbours: tuple[Part, ...] = ()
    beside: tuple[ContrastTube, ...] = ()
    cortex_mm: float = 1.2
    cortex_hu: float = 900.0
    marrow_hu: float = 160.0
    tissue_hu: float = 40.0
    rotation: Array = field(default_factory=lambda: np.eye(3))
    place_mm: Array = field(default_factory=lambda: np.zeros(3))

    def hu_at(self, points_lps_mm: Array) -> Array:
        """Return Hounsfield units (n,) at points (n, 3) in LPS mm."""
        p = (points_lps_mm - self.place_mm) @ self.rotation
        hu = np.full(len(p), self.tissue_hu)
        for thing in self.beside:
            hu[thing.part.distance_mm(p) < 0.0] = thing.hu
        for solids in (self.neighbours, (*self.pedicles.values(), *self.bones)):
            distance = np.full(len(p), NOWHERE_MM)
            for solid in solids:
                np.minimum(distance, solid.distance_mm(p), out=distance)
            hu[distance < 0.0] = self.cortex_hu
            hu[distance < -self.cortex_mm] = self.marrow_hu
        return hu

    def bone_distance_mm(self, points_lps_mm: Array) -> Array:
        """Return the signed distance (n,) to the vertebra's surface, negative inside."""
        p = (points_lps_mm - self.place_mm) @ self.rotation
        solids = (*self.pedicles.values(), *self.bones)
        return np.asarray(np.min([solid.distance_mm(p) for solid in solids], axis=0))

    def truth(self, side: str) -> PedicleTruth:
        """Return the ground truth of the pedicle on this side."""
        pedicle = self.pedicles[side]
        isthmus = self.rotation @ pedicle.waist_mm + self.place_mm
        axis = self.rotation @ pedicle.axis
        ahead_mm, behind_mm = self._leaves_mm(isthmus, axis), self._leaves_mm(isthmus, -axis)
        return PedicleTruth(
            width_mm=pedicle.width_mm,
            height_mm=pedicle.height_mm,
            isthmus_lps_mm=isthmus,
            axis_lps=axis,
            length_mm=ahead_mm + behind_mm,
        )

    def _leaves_mm(self, start_mm: Array, direction: Array) -> float:
        """Return the distance at which a line leaves the vertebra; touching solids count as one."""
        steps = np.arange(0.0, 80.0, 0.01)
        distance = self.bone_distance_mm(start_mm + steps[:, None] * direction)
        left = int(np.argmax(distance > TOUCH_MM))
        inside = np.flatnonzero(distance[:left] <= 0.0)
        return float(steps[inside[-1]])

    def seed_lps_mm(self, side: str, offset_mm: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Array:
        """Return a click in the pedicle, offset along its axis, width and height from the isthmus."""
        pedicle = self.pedicles[side]
        up = np.cross(pedicle.axis, pedicle.across)
        at = pedicle.waist_mm + np.stack([pedicle.axis, pedicle.across, up], axis=1) @ np.array(offset_mm)
        return np.asarray(self.rotation @ at + self.place_mm)


def pedicle_tube(
    side: str,
    *,
    width_mm: float,
    height_mm: float,
    transverse_deg: float,
    sagittal_deg: float,
    waist_mm: tuple[float, float, float],
    roll_deg: float = 0.0,
    widening_per_mm2: float = 0.0,
    bend_per_mm: float = 0.0,
) -> EllipticTube:
    """Return a pedicle from its parameters; `waist_mm` is for the left side and mirrored for the right.

    The angles are those of the axis projected onto an axial and a sagittal slice, positive medially and
    cranially in the anterior direction.
    """
    mirror = 1.0 if side == "left" else -1.0
    axis = np.array([-mirror * np.tan(np.radians(transverse_deg)), -1.0, np.tan(np.radians(sagittal_deg))])
    axis /= np.linalg.norm(axis)
    level = np.array([1.0, 0.0, 0.0]) - axis * axis[0]
    level /= np.linalg.norm(level)
    roll = np.radians(roll_deg)
    across = np.cos(roll) * level + np.sin(roll) * np.cross(axis, level)
    return EllipticTube(
        waist_mm=np.array(waist_mm) * [mirror, 1.0, 1.0],
        axis=axis,
        across=across,
        width_mm=width_mm,
        height_mm=height_mm,
        widening_per_mm2=widening_per_mm2,
        bend_per_mm=bend_per_mm,
    )


def usual_bones() -> tuple[Part, ...]:
    """Return body, arch, transverse and spinous processes around a canal at the origin."""
    return (
        Drum(centre_mm=np.array([0.0, -27.0, 0.0]), half_mm=(23.0, 17.0, 14.0)),
        Block(centre_mm=np.array([0.0, 15.0, -3.0]), half_mm=(20.0, 5.0, 11.0)),
        Block(centre_mm=np.array([0.0, 30.0, -6.0]), half_mm=(3.5, 14.0, 9.0)),
        Rod(start_mm=np.array([15.0, 13.0, 2.0]), end_mm=np.array([38.0, 17.0, 4.0]), radius_mm=4.5),
        Rod(start_mm=np.array([-15.0, 13.0, 2.0]), end_mm=np.array([-38.0, 17.0, 4.0]), radius_mm=4.5),
    )
