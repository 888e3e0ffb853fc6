"""Clearance of a screw to each pedicle wall, and the grade of a breach."""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from tracker.geometry import Array
from tracker.plan.channel import Channel
from tracker.plan.pedicle import PedicleMeasure

# Length behind the isthmus to which its outline applies, because the arch is wider, and the number of
# sections.
HALF_LENGTH_MM, PLACES = 3.0, 7
WALLS = ("medial", "lateral", "superior", "inferior")


class GertzbeinRobbins(StrEnum):
    """Grade of a pedicle wall breach (Gertzbein and Robbins, Spine 1990)."""

    A = "A"
    B = "B"
    C = "C"
    D = "D"
    E = "E"


@dataclass(frozen=True, slots=True, kw_only=True)
class Clearance:
    """Distance from the screw's surface to each outer wall, in mm; negative for a breach.

    Attributes:
        medial_mm: clearance towards the canal; likewise lateral_mm, superior_mm, inferior_mm.
        anterior_mm: from the screw's end to the front wall of the body, along the screw.
        breach_mm: the deepest breach of the pedicle's wall in any direction, 0 if there is none.
        grade: of that breach.
    """

    medial_mm: float
    lateral_mm: float
    superior_mm: float
    inferior_mm: float
    anterior_mm: float
    breach_mm: float
    grade: GertzbeinRobbins

    @property
    def min_mm(self) -> float:
        """Return the minimum clearance to a wall of the pedicle."""
        return min(self.medial_mm, self.lateral_mm, self.superior_mm, self.inferior_mm)


def grade_of_breach(breach_mm: float) -> GertzbeinRobbins:
    """A: within the pedicle; B: under 2 mm through its wall; C: under 4; D: under 6; E: 6 mm or more."""
    if breach_mm <= 0.0:
        return GertzbeinRobbins.A
    for grade, below_mm in ((GertzbeinRobbins.B, 2.0), (GertzbeinRobbins.C, 4.0), (GertzbeinRobbins.D, 6.0)):
        if breach_mm < below_mm:
            return grade
    return GertzbeinRobbins.E


def clearance_of(
    channel: Channel, measure: PedicleMeasure, *, diameter_mm: float, length_mm: float
) -> Clearance:
    """Return the clearance of a screw on the channel's axis, starting at its entry.

    The screw's cylinder is compared with the outline of the isthmus, extruded from 3 mm behind it to where
    the pedicle opens into the body, and anteriorly with the tangent plane of the anterior wall.
    """
    gaps = wall_gaps_mm(channel, measure) - 0.5 * diameter_mm
    towards = _towards(measure)
    # Each wall is the part of the outline within 45 degrees of its direction.
    by_wall = [
        float(gaps[towards == n].min()) if (towards == n).any() else float(gaps.min()) for n in range(4)
    ]
    breach = float(max(-gaps.min(), 0.0))
    end = channel.entry_in_vertebra_mm + length_mm * channel.axis_in_vertebra
    ahead = float((measure.front_lps_mm - end) @ measure.axis_lps)
    slope = float(channel.axis_in_vertebra @ measure.axis_lps)
    return Clearance(
        medial_mm=by_wall[0],
        lateral_mm=by_wall[1],
        superior_mm=by_wall[2],
        inferior_mm=by_wall[3],
        anterior_mm=ahead / max(slope, 0.1),
        breach_mm=breach,
        grade=grade_of_breach(breach),
    )


def wall_gaps_mm(channel: Channel, measure: PedicleMeasure) -> Array:
    """Return the minimum distance from the channel's axis to each outline point (n,) in the pedicle.

    Negative where the axis itself lies outside the pedicle.
    """
    return np.asarray(gaps_along_mm(channel, measure)[1].min(axis=0))


def gaps_along_mm(channel: Channel, measure: PedicleMeasure) -> tuple[Array, Array]:
    """Return places in the pedicle (m,), from the isthmus forwards, and distances (m, n) to the outline.

    The outline of the isthmus is used for each section from 3 mm behind it to where the pedicle opens into
    the body, because all of them are wider.
    """
    places = np.linspace(-HALF_LENGTH_MM, max(measure.opens_ahead_mm, HALF_LENGTH_MM), PLACES)
    slope = float(channel.axis_in_vertebra @ measure.axis_lps)
    normal = outward_normals(measure.outline_lps_mm, measure)
    gaps = []
    for along in places:
        centre = measure.isthmus_lps_mm + along * measure.axis_lps
        wall = measure.outline_lps_mm + along * measure.axis_lps
        reach = float((centre - channel.entry_in_vertebra_mm) @ measure.axis_lps) / (
            slope if abs(slope) > 0.1 else 0.1
        )
        crossing = channel.entry_in_vertebra_mm + reach * channel.axis_in_vertebra
        gaps.append(((wall - crossing) * normal).sum(axis=1))
    return places, np.array(gaps)


def outward_normals(wall: Array, measure: PedicleMeasure) -> Array:
    """Return the unit normals (n, 3) of a closed outline (n, 3), perpendicular to the pedicle's axis."""
    tangent = np.roll(wall, -1, axis=0) - np.roll(wall, 1, axis=0)
    normal = np.cross(tangent, measure.axis_lps)
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-12)
    outwards = ((wall - wall.mean(axis=0)) * normal).sum(axis=1).mean()
    return np.asarray(normal * np.sign(outwards))


def _towards(measure: PedicleMeasure) -> Array:
    """Return the wall (n,) of each outline point, as an index into `WALLS`, by its normal."""
    normal = outward_normals(measure.outline_lps_mm, measure)
    up = np.array([0.0, 0.0, 1.0]) - measure.axis_lps * measure.axis_lps[2]
    up /= np.linalg.norm(up)
    medial = np.cross(up, measure.axis_lps)
    medial *= np.sign(medial[0]) * (-1.0 if measure.side == "left" else 1.0)
    along = np.stack([normal @ medial, -(normal @ medial), normal @ up, -(normal @ up)], axis=1)
    return np.asarray(np.argmax(along, axis=1))
