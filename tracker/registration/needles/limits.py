"""What a registration by needles must reach."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class NeedleLimits:
    """The gate of a registration by needles.

    Attributes:
        max_offset_mm: how far a needle's line, or its entry where it is seen, may miss its place.
        min_probability_ratio: needles, ruler and touched points that all hold agree worse than theirs do only
            in this share of cases; below it something is wrong.
        min_lead: by how much another pose must be worse, as a difference of chi squared.
        max_lead_of_swapped: by how much needles marked in another order may fit better, by chance.
    """

    max_offset_mm: float = 3.0
    min_probability_ratio: float = 0.001
    min_lead: float = 6.0
    max_lead_of_swapped: float = 3.0
