"""Capture of a landmark: the tip is held on it, and taken only if it was seen and still in every image."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from tracker.errors import RegistrationError
from tracker.geometry import Array, nearest_rotation


@dataclass(frozen=True, slots=True, kw_only=True)
class CaptureSettings:
    """What a capture must be like.

    Attributes:
        least_images: how many images.
        least_s: over how long they must reach, so that a hand's tremor is in them.
        most_s: how long is waited for that.
        most_gap_s: between two images; a longer gap means that images were lost.
        most_sd_mm: spread of the tip along its worst axis.
        most_off_mm: the farthest single image from the mean.
        most_tip_sd_mm: what an image may state of its own tip (root of the trace).
    """

    least_images: int = 12
    least_s: float = 0.4
    most_s: float = 2.0
    most_gap_s: float = 0.25
    most_sd_mm: float = 0.4
    most_off_mm: float = 1.2
    most_tip_sd_mm: float = 3.0


@dataclass(frozen=True, slots=True, kw_only=True)
class TipSample:
    """The tip in one image, seen.

    Attributes:
        at_s: when.
        tip_in_anchor_mm: (3,).
        covariance_mm2: (3, 3), of all that is unsure, the tip behind its marker with it.
        anchor_from_marker: (3, 3), how the tool's marker is turned.
        tip_covariance_mm2: (3, 3) of the tip behind its marker, in the marker's frame.
    """

    at_s: float
    tip_in_anchor_mm: Array
    covariance_mm2: Array
    anchor_from_marker: Array = field(default_factory=lambda: np.eye(3))
    tip_covariance_mm2: Array = field(default_factory=lambda: np.zeros((3, 3)))


@dataclass(frozen=True, slots=True, kw_only=True)
class UnseenSample:
    """An image in which the tip is not known, with the reason."""

    at_s: float
    reason: str


@dataclass(frozen=True, slots=True, kw_only=True)
class CapturedLandmark:
    """Where the tip was held.

    Attributes:
        tip_in_anchor_mm: (3,) the mean.
        covariance_mm2: (3, 3) of the mean: what is common to all images, and what is left of the rest.
        anchor_from_marker: (3, 3), how the tool's marker was turned.
        tip_covariance_mm2: (3, 3) of the tip behind its marker, in the marker's frame; it is in
            `covariance_mm2`, and common to all landmarks that this tool touches.
        images: how many.
        spread_mm: (3,) standard deviation along the anchor's axes.
        most_off_mm: the farthest single image from the mean.
        lasted_s: from the first image to the last.
    """

    tip_in_anchor_mm: Array
    covariance_mm2: Array
    images: int
    spread_mm: Array
    most_off_mm: float
    lasted_s: float
    anchor_from_marker: Array = field(default_factory=lambda: np.eye(3))
    tip_covariance_mm2: Array = field(default_factory=lambda: np.zeros((3, 3)))

    @property
    def own_covariance_mm2(self) -> Array:
        """(3, 3), of what this touch errs by itself: all but the tip behind its marker."""
        of_tip = self.anchor_from_marker @ self.tip_covariance_mm2 @ self.anchor_from_marker.T
        values, vectors = np.linalg.eigh(self.covariance_mm2 - of_tip)
        # Turned a little from image to image, the tip's part may be larger than what is taken away here.
        return np.asarray((vectors * np.maximum(values, 0.0)) @ vectors.T)


class LandmarkCollector:
    """Gathers the images of one capture. Mutable: holds what was seen. Time arrives as a number."""

    def __init__(self, settings: CaptureSettings | None = None) -> None:
        self._settings = settings or CaptureSettings()
        self._samples: list[TipSample | UnseenSample] = []

    def take(self, sample: TipSample | UnseenSample) -> None:
        """One image, in the order of time; the tip seen or not."""
        self._samples.append(sample)

    @property
    def is_over(self) -> bool:
        """Whether there is enough to judge, or no point in waiting."""
        if not self._samples:
            return False
        lasted = self._samples[-1].at_s - self._samples[0].at_s
        enough = len(self._samples) >= self._settings.least_images and lasted >= self._settings.least_s
        unseen = isinstance(self._samples[-1], UnseenSample)
        return enough or unseen or lasted >= self._settings.most_s

    def result(self, common_covariance_mm2: npt.ArrayLike | None = None) -> CapturedLandmark:
        """The landmark. Raises as `captured`."""
        return captured(self._samples, self._settings, common_covariance_mm2)


def captured(
    samples: Sequence[TipSample | UnseenSample],
    settings: CaptureSettings | None = None,
    common_covariance_mm2: npt.ArrayLike | None = None,
) -> CapturedLandmark:
    """Where the tip was held, from all images in which it was held.

    `common_covariance_mm2`: (3, 3) of what does not average out, such as the tip's calibration. Left out, all
    that the images state of themselves counts as common: of a tool at rest the errors are alike.

    Raises:
        RegistrationError: CAPTURE_UNSEEN, CAPTURE_TOO_SHORT, CAPTURE_UNCERTAIN or CAPTURE_MOVED.
    """
    settings = settings or CaptureSettings()
    seen = [sample for sample in samples if isinstance(sample, TipSample)]
    _refuse_unseen(samples)
    _refuse_short(seen, settings)
    tips = np.array([sample.tip_in_anchor_mm for sample in seen], dtype=np.float64)
    stated = np.array([sample.covariance_mm2 for sample in seen], dtype=np.float64)
    _refuse_uncertain(tips, stated, settings)
    mean = tips.mean(axis=0)
    scatter = np.cov(tips.T)
    off = float(np.linalg.norm(tips - mean, axis=1).max())
    _refuse_moved(scatter, off, settings)
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
        most_off_mm=off,
        lasted_s=seen[-1].at_s - seen[0].at_s,
        anchor_from_marker=nearest_rotation(np.mean([sample.anchor_from_marker for sample in seen], axis=0)),
        tip_covariance_mm2=seen[0].tip_covariance_mm2,
    )


def _refuse_unseen(samples: Sequence[TipSample | UnseenSample]) -> None:
    reasons = [sample.reason for sample in samples if isinstance(sample, UnseenSample)]
    if reasons:
        most = max(sorted(set(reasons)), key=reasons.count)
        raise RegistrationError(
            "CAPTURE_UNSEEN",
            f"the tip was known in {len(samples) - len(reasons)} of {len(samples)} images, needed in all "
            f"({most})",
            "Turn the markers to the camera, keep hands off them, and touch the landmark again.",
            {"seen": len(samples) - len(reasons), "images": len(samples), "reason": most},
        )


def _refuse_short(seen: Sequence[TipSample], settings: CaptureSettings) -> None:
    times = np.array([sample.at_s for sample in seen])
    lasted = float(times[-1] - times[0]) if len(times) else 0.0
    gap = float(np.diff(times).max()) if len(times) > 1 else 0.0
    in_order = bool((np.diff(times) > 0.0).all())
    long_enough = len(seen) >= settings.least_images and lasted >= settings.least_s
    if not (long_enough and gap <= settings.most_gap_s and in_order):
        raise RegistrationError(
            "CAPTURE_TOO_SHORT",
            f"there are {len(seen)} images over {lasted:.2f} s with gaps of up to {gap:.2f} s, "
            f"needed {settings.least_images} over {settings.least_s:g} s with gaps of "
            f"{settings.most_gap_s:g} s at most",
            "Keep the tip on the landmark until it is taken.",
            {"images": len(seen), "lasted_s": lasted, "gap_s": gap, "needed": settings.least_images},
        )


def _refuse_uncertain(tips: Array, stated: Array, settings: CaptureSettings) -> None:
    sd = float(np.sqrt(np.trace(stated, axis1=1, axis2=2).max()))
    if not (np.isfinite(tips).all() and sd <= settings.most_tip_sd_mm):
        raise RegistrationError(
            "CAPTURE_UNCERTAIN",
            f"the tip is known to {sd:.1f} mm in the worst image, allowed {settings.most_tip_sd_mm:g} mm",
            "Hold the marker nearer to the camera and in better light, and touch the landmark again.",
            {"tip_sd_mm": sd, "allowed_mm": settings.most_tip_sd_mm},
        )


def _refuse_moved(scatter: Array, off_mm: float, settings: CaptureSettings) -> None:
    sd = float(np.sqrt(max(np.linalg.eigvalsh(scatter)[-1], 0.0)))
    if sd > settings.most_sd_mm or off_mm > settings.most_off_mm:
        raise RegistrationError(
            "CAPTURE_MOVED",
            f"the tip moved: it spreads by {sd:.2f} mm (standard deviation, allowed {settings.most_sd_mm:g}) "
            f"and by {off_mm:.2f} mm at most (allowed {settings.most_off_mm:g})",
            "Rest the hand, hold the tip still on the landmark, and touch it again.",
            {"spread_mm": sd, "most_off_mm": off_mm, "allowed_mm": settings.most_sd_mm},
        )
