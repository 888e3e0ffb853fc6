"""Limits of an accepted registration by needles."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class NeedleLimits:
    """Limits of an accepted registration by needles.

    Attributes:
        max_offset_mm: maximum distance of a needle's line, or of its entry if visible, from its planned
            position.
        min_probability_ratio: minimum p-value of chi squared.
        min_delta_chi2: minimum delta chi-square of another pose.
        max_swap_delta_chi2: maximum decrease of chi-square by another order of the needles.
    """

    max_offset_mm: float = 3.0
    min_probability_ratio: float = 0.001
    min_delta_chi2: float = 6.0
    max_swap_delta_chi2: float = 3.0
