"""Magnitude of the simulated human errors, and sampling of the simulated operation."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class VerificationSettings:
    """Standard deviations of the simulated errors, equal to what the software assumes, and sampling times.

    Attributes:
        tip_sd_mm: of the tool's calibrated tip, along each axis.
        axis_sd_deg: of its calibrated axis, to each of two sides.
        marking_sd_mm: how well a landmark is marked on the CT, along each axis: half a voxel and more.
            Registration takes no landmark for surer than 0.5 mm in all, whatever the residuals say; below
            that it would state too much here.
        placing_sd_mm: how well a needle is put on its landmark, along each axis.
        click_sd_px: how well a needle is marked in the image.
        image_hz: how fast images come.
        capture_images: with the tip on one landmark.
        observations: number of observations of the operation, spread over its duration.
        burst_images: consecutive images of each observation; the last one counts.
        moves_at_s: when the camera is moved.
        observed_after_move_s: for how long after that every image is looked at.
        noticed_within_s: a move must be noticed within this.
    """

    tip_sd_mm: float = 0.15
    axis_sd_deg: float = 0.15
    marking_sd_mm: float = 0.4
    placing_sd_mm: float = 0.7
    click_sd_px: float = 1.0
    image_hz: float = 30.0
    capture_images: int = 14
    observations: int = 12
    burst_images: int = 3
    moves_at_s: float = 17.0
    observed_after_move_s: float = 1.4
    noticed_within_s: float = 1.2
