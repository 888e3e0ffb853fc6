"""What points must be like to be fitted, and what a fit must reach to be used."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class PointSettings:
    """When points are refused, and how well a landmark can be found at all.

    Attributes:
        min_fle_mm: how well a landmark is found on bone and on the CT at best (3-D RMS); no residuals,
            however small, make the stated uncertainty narrower than that.
        min_apart_mm: points that are nearer to each other are one.
        min_spread_ratio: of the second extent of the points to the first; below, they are a line.
        max_turn_sd_deg: how unsure the rotation about the points' own line may be if landmarks were found
            as well as `min_fle_mm` says.
        wrong_fre_mm: no order is called wrong whose FRE is smaller.
        clearly_ratio: by how much another order, or the mirror image, must fit better to be called right.
    """

    min_fle_mm: float = 0.5
    min_apart_mm: float = 1.0
    min_spread_ratio: float = 0.05
    max_turn_sd_deg: float = 5.0
    wrong_fre_mm: float = 1.5
    clearly_ratio: float = 3.0


@dataclass(frozen=True, slots=True, kw_only=True)
class PointGate:
    """What a registration by points must reach before it is used.

    Attributes:
        max_fre_mm: root mean square distance of the landmarks. Says that no landmark was mistaken; it does
            not say how true the registration is at the target.
        max_tre_mm: the stated error (3-D RMS) at each target.
    """

    max_fre_mm: float = 1.5
    max_tre_mm: float = 2.0
