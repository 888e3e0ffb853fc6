"""What a sweep must be like to be fitted, and what the fit must reach to be used."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class SurfaceSettings:
    """How a sweep is fitted.

    Attributes:
        min_points: fewer say too little.
        min_sd_mm: how well tip and CT agree on where the bone's surface is, at best; no fit, however good,
            is believed better.
        alike_mm: swept points that are nearer to each other than this err alike and count as one.
        landmark_sd_mm: of a landmark along each axis, where landmarks count too and state nothing.
        max_start_off_mm: median distance of the sweep from the surface at the start.
        min_used_ratio: share of the sweep that must agree.
        max_slide_sd_mm: how unsure any of the six directions may be, in mm at the target's lever.
        tried_shift_mm, tried_turn_deg: how far beside the start other starts are.
        max_apart_mm: two fits that are nearer at the target than this are one.
        tip_radius_mm: of a ball at the tip, whose middle is what is tracked.
    """

    min_points: int = 12
    min_sd_mm: float = 0.3
    alike_mm: float = 1.5
    landmark_sd_mm: float = 1.0
    max_start_off_mm: float = 10.0
    min_used_ratio: float = 0.6
    max_slide_sd_mm: float = 1.0
    tried_shift_mm: float = 4.0
    tried_turn_deg: float = 8.0
    max_apart_mm: float = 1.5
    tip_radius_mm: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class SurfaceGate:
    """What a registration by surface must reach before it is used.

    Attributes:
        max_rms_mm: of the distances of the points that agree.
        max_tre_mm: the stated error (3-D RMS) at each target.
        max_moved_mm: how far the fit may lie from its start, at the middle of the sweep.
    """

    max_rms_mm: float = 1.0
    max_tre_mm: float = 2.0
    max_moved_mm: float = 10.0
