"""Capture a landmark: the tip must be seen and still in every image."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from tracker.errors import RegistrationError
from tracker.geometry import Array, nearest_rotation
from tracker.pose.image_rate import GapLimit, image_period_s
from tracker.registration.capture_rate import CaptureRate

# Minimum number of intervals for an estimate of the image rate that can reject a capture.
MIN_INTERVALS = 3


@dataclass(frozen=True, slots=True, kw_only=True)
class CaptureSettings:
    """Requirements of a capture.

    Attributes:
        min_images: minimum number of images.
        min_s: minimum duration, so that a hand's tremor is sampled.
        max_s: maximum duration; an image rate at which `min_images` take longer is too low.
        gap: limit of the time between two images; in a longer gap the tip could have moved.
        max_sd_mm: standard deviation of the tip along its worst axis.
        max_off_mm: maximum distance of a single image from the mean.
        max_tip_sd_mm: maximum uncertainty of the tip in an image (root of the trace).
    """

    min_images: int = 12
    min_s: float = 0.4
    max_s: float = 8.0
    gap: GapLimit = field(default_factory=GapLimit)
    max_sd_mm: float = 0.4
    max_off_mm: float = 1.2
    max_tip_sd_mm: float = 3.0

    def hold_s(self, period_s: float) -> float:
        """Return the required duration of the capture [s] at an image period of `period_s`."""
        return max(self.min_s, self.min_images * period_s)


@dataclass(frozen=True, slots=True, kw_only=True)
class TipSample:
    """Position of the tip in one image.

    Attributes:
        at_s: time of the image.
        tip_in_anchor_mm: (3,), the tip in the anchor frame.
        covariance_mm2: (3, 3), total, including the calibration of the tip.
        anchor_from_marker: (3, 3), rotation of the tool's marker.
        tip_covariance_mm2: (3, 3) of the tip's calibration, in the marker frame.
        image_number: as counted by the camera, including untracked images; None if unknown.
    """

    at_s: float
    tip_in_anchor_mm: Array
    covariance_mm2: Array
    anchor_from_marker: Array = field(default_factory=lambda: np.eye(3))
    tip_covariance_mm2: Array = field(default_factory=lambda: np.zeros((3, 3)))
    image_number: int | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class UnseenSample:
    """An image without a position of the tip, with the reason."""

    at_s: float
    reason: str
    image_number: int | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class CapturedLandmark:
    """Result of a capture.

    Attributes:
        tip_in_anchor_mm: (3,) mean position.
        covariance_mm2: (3, 3) of the mean: the common part of all images plus the averaged noise.
        anchor_from_marker: (3, 3), mean rotation of the tool's marker.
        tip_covariance_mm2: (3, 3) of the tip's calibration, in the marker frame; included in `covariance_mm2`
            and common to all landmarks captured with this tool.
        images: number of images.
        spread_mm: (3,) standard deviation along the anchor's axes.
        max_off_mm: maximum distance of a single image from the mean.
        lasted_s: time from the first image to the last.
    """

    tip_in_anchor_mm: Array
    covariance_mm2: Array
    images: int
    spread_mm: Array
    max_off_mm: float
    lasted_s: float
    anchor_from_marker: Array = field(default_factory=lambda: np.eye(3))
    tip_covariance_mm2: Array = field(default_factory=lambda: np.zeros((3, 3)))

    @property
    def own_covariance_mm2(self) -> Array:
        """Return the covariance (3, 3) of this capture without the common calibration of the tip."""
        of_tip = self.anchor_from_marker @ self.tip_covariance_mm2 @ self.anchor_from_marker.T
        values, vectors = np.linalg.eigh(self.covariance_mm2 - of_tip)
        # The orientation varies between images, so the subtraction can make small eigenvalues negative.
        return np.asarray((vectors * np.maximum(values, 0.0)) @ vectors.T)


class LandmarkCollector:
    """Collect the images of one capture. Mutable; has no clock."""

    def __init__(self, settings: CaptureSettings | None = None) -> None:
        self._settings = settings or CaptureSettings()
        self._samples: list[TipSample | UnseenSample] = []

    def take(self, sample: TipSample | UnseenSample) -> None:
        """Add one image, in chronological order."""
        self._samples.append(sample)

    @property
    def is_over(self) -> bool:
        """Return whether the capture is complete or can no longer succeed."""
        if not self._samples:
            return False
        unseen = isinstance(self._samples[-1], UnseenSample)
        return unseen or self._is_enough or self._is_hopeless

    @property
    def rate_hz(self) -> float | None:
        """Return the image rate so far [images/s]; None before the second image."""
        rate = _rate_of(self._samples)
        return None if rate is None else rate.tracked_hz

    @property
    def left_s(self) -> float | None:
        """Return the remaining time [s] at this rate; None before the second image."""
        rate = _rate_of(self._samples)
        if rate is None:
            return None
        missing = self._settings.min_images - len(self._samples)
        return max(0.0, missing * rate.period_s, self._settings.min_s - self._lasted_s)

    @property
    def _lasted_s(self) -> float:
        return self._samples[-1].at_s - self._samples[0].at_s

    @property
    def _is_enough(self) -> bool:
        settings = self._settings
        return len(self._samples) >= settings.min_images and self._lasted_s >= settings.min_s

    @property
    def _is_hopeless(self) -> bool:
        """Return whether the capture can only be rejected: too long, interrupted, or at too low a rate."""
        settings = self._settings
        times_s = [sample.at_s for sample in self._samples]
        gap_s = times_s[-1] - times_s[-2] if len(times_s) > 1 else 0.0
        if self._lasted_s >= settings.max_s or gap_s > settings.gap.max_s:
            return True
        period_s = image_period_s(times_s, min_intervals=MIN_INTERVALS)
        return period_s is not None and settings.hold_s(period_s) > settings.max_s

    def result(self, common_covariance_mm2: npt.ArrayLike | None = None) -> CapturedLandmark:
        """Return the landmark. Raises as `captured`."""
        return captured(self._samples, self._settings, common_covariance_mm2)


def captured(
    samples: Sequence[TipSample | UnseenSample],
    settings: CaptureSettings | None = None,
    common_covariance_mm2: npt.ArrayLike | None = None,
) -> CapturedLandmark:
    """Compute a landmark from all images of its capture.

    `common_covariance_mm2`: (3, 3) of errors that do not average out, such as the tip's calibration. If None,
    the stated covariance counts as common: the errors of a tool at rest are correlated.

    Raises:
        RegistrationError: CAPTURE_UNSEEN, CAPTURE_INTERRUPTED, CAPTURE_RATE_TOO_LOW, CAPTURE_TOO_SHORT,
            CAPTURE_UNCERTAIN or CAPTURE_MOVED.
    """
    settings = settings or CaptureSettings()
    seen = [sample for sample in samples if isinstance(sample, TipSample)]
    rate = _rate_of(samples)
    _reject_unseen(samples, rate)
    _reject_interrupted(seen, rate, settings)
    _reject_short(seen, rate, settings)
    tips = np.array([sample.tip_in_anchor_mm for sample in seen], dtype=np.float64)
    stated = np.array([sample.covariance_mm2 for sample in seen], dtype=np.float64)
    _reject_uncertain(tips, stated, settings)
    mean = tips.mean(axis=0)
    scatter = np.cov(tips.T)
    off = float(np.linalg.norm(tips - mean, axis=1).max())
    _reject_moved(scatter, off, settings)
    common = stated.mean(axis=0) if common_covariance_mm2 is None else np.asarray(common_covariance_mm2)
    covariance = common + scatter / len(seen)
    spread = np.sqrt(np.diag(scatter))
    for array in (mean, covariance, spread):
        array.setflags(write=False)
    return CapturedLandmark(
        tip_in_anchor_mm=mean,
        covariance_mm2=covariance,
        images=len(seen),
        spread_mm=spread,
        max_off_mm=off,
        lasted_s=seen[-1].at_s - seen[0].at_s,
        anchor_from_marker=nearest_rotation(np.mean([sample.anchor_from_marker for sample in seen], axis=0)),
        tip_covariance_mm2=seen[0].tip_covariance_mm2,
    )


def _reject_unseen(samples: Sequence[TipSample | UnseenSample], rate: CaptureRate | None) -> None:
    reasons = [sample.reason for sample in samples if isinstance(sample, UnseenSample)]
    if reasons:
        reason = max(sorted(set(reasons)), key=reasons.count)
        seen = len(samples) - len(reasons)
        raise RegistrationError(
            "CAPTURE_UNSEEN",
            f"the tip was known in {seen} of {len(samples)} images{_at(rate)} and not in {len(reasons)} "
            f"({reason}), needed in all",
            "Turn the markers to the camera, do not cover them, and touch the landmark again.",
            {
                "seen": seen,
                "images": len(samples),
                "unseen": len(reasons),
                "reason": reason,
                "rate_hz": _hz(rate),
                "at_rate": _at(rate),
                "unseen_reason": reason,
            },
        )


def _reject_interrupted(
    seen: Sequence[TipSample], rate: CaptureRate | None, settings: CaptureSettings
) -> None:
    if rate is None:
        return
    gap_s = float(np.diff([sample.at_s for sample in seen]).max())
    allowed_s = settings.gap.allowed_s(rate.period_s)
    if gap_s > allowed_s:
        raise RegistrationError(
            "CAPTURE_INTERRUPTED",
            f"{gap_s:.2f} s passed between two of {len(seen)} images, allowed {allowed_s:.2f} s at "
            f"{rate.text}: the tip could have moved in between",
            f"Hold the tip still, and touch the landmark again.{rate.remedy}",
            {
                "images": len(seen),
                "gap_s": gap_s,
                "allowed_s": allowed_s,
                "rate_hz": rate.tracked_hz,
                "rate_text": rate.text,
                "rate_remedy": rate.remedy,
            },
        )


def _reject_short(seen: Sequence[TipSample], rate: CaptureRate | None, settings: CaptureSettings) -> None:
    times_s = np.array([sample.at_s for sample in seen])
    lasted_s = float(times_s[-1] - times_s[0]) if len(times_s) else 0.0
    in_order = bool((np.diff(times_s) > 0.0).all())
    if in_order and len(seen) >= settings.min_images and lasted_s >= settings.min_s:
        return
    hold_s = settings.min_s if rate is None else settings.hold_s(rate.period_s)
    context = {
        "images": len(seen),
        "lasted_s": lasted_s,
        "needed": settings.min_images,
        "min_s": settings.min_s,
        "hold_s": hold_s,
        "max_s": settings.max_s,
        "rate_hz": _hz(rate),
    }
    if rate is not None and hold_s > settings.max_s:
        raise RegistrationError(
            "CAPTURE_RATE_TOO_LOW",
            f"{settings.min_images} images take {hold_s:.1f} s at {rate.text}, allowed {settings.max_s:g} s",
            f"Touch the landmark again when images come faster.{rate.remedy}",
            {**context, "rate_text": rate.text, "rate_remedy": rate.remedy},
        )
    order = "" if in_order else ", out of order"
    how_long = "" if rate is None else f" for {hold_s:.1f} s at {rate.text},"
    raise RegistrationError(
        "CAPTURE_TOO_SHORT",
        f"there are {len(seen)} images over {lasted_s:.2f} s{_at(rate)}{order}, needed "
        f"{settings.min_images} over {settings.min_s:g} s",
        f"Hold the tip still on the landmark{how_long} until it is taken.",
        {**context, "at_rate": _at(rate), "order": order, "hold_hint": how_long},
    )


def _rate_of(samples: Sequence[TipSample | UnseenSample]) -> CaptureRate | None:
    return CaptureRate.of([one.at_s for one in samples], [one.image_number for one in samples])


def _at(rate: CaptureRate | None) -> str:
    return "" if rate is None else f" at {rate.text}"


def _hz(rate: CaptureRate | None) -> float | None:
    return None if rate is None else rate.tracked_hz


def _reject_uncertain(tips: Array, stated: Array, settings: CaptureSettings) -> None:
    sd = float(np.sqrt(np.trace(stated, axis1=1, axis2=2).max()))
    if not (np.isfinite(tips).all() and sd <= settings.max_tip_sd_mm):
        raise RegistrationError(
            "CAPTURE_UNCERTAIN",
            f"the tip's uncertainty is {sd:.1f} mm in the worst image, allowed {settings.max_tip_sd_mm:g} mm",
            "Hold the marker nearer to the camera and in better light, and touch the landmark again.",
            {"tip_sd_mm": sd, "allowed_mm": settings.max_tip_sd_mm},
        )


def _reject_moved(scatter: Array, off_mm: float, settings: CaptureSettings) -> None:
    sd = float(np.sqrt(max(np.linalg.eigvalsh(scatter)[-1], 0.0)))
    if sd > settings.max_sd_mm or off_mm > settings.max_off_mm:
        raise RegistrationError(
            "CAPTURE_MOVED",
            f"the tip moved: it spreads by {sd:.2f} mm (standard deviation, allowed {settings.max_sd_mm:g}) "
            f"and by {off_mm:.2f} mm at most (allowed {settings.max_off_mm:g})",
            "Rest the hand, hold the tip still on the landmark, and touch it again.",
            {
                "spread_mm": sd,
                "max_off_mm": off_mm,
                "allowed_mm": settings.max_sd_mm,
                "allowed_off_mm": settings.max_off_mm,
            },
        )
