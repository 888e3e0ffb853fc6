"""Magnitude of the simulated human errors, and sampling of the simulated operation."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class VerificationSettings:
    """Standard deviations of the simulated errors, equal to what the software assumes, and sampling times.

    Attributes:
        tip_sd_mm: sd of the tool's calibrated tip along each axis.
        axis_sd_deg: sd of its calibrated axis in each of two directions.
        marking_sd_mm: sd of marking a landmark on the CT along each axis, at least half a voxel. Registration
            assumes a landmark sd of at least 0.5 mm in total, whatever the residuals; a smaller value here
            would make the stated uncertainty too large.
        placing_sd_mm: sd of placing a needle on its landmark along each axis.
        click_sd_px: sd of marking a needle in the image.
        image_hz: image rate.
        capture_images: number of images with the tip on one landmark.
        observations: number of observations of the operation, spread over its duration.
        burst_images: consecutive images of each observation; the last one counts.
        moves_at_s: time at which the camera is moved.
        observed_after_move_s: time after the move in which every image is evaluated.
        noticed_within_s: time limit for the detection of the move.
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
