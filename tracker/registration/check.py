"""Check on anatomy: distance of the tip from a landmark that was not used for the registration."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.errors import RegistrationError
from tracker.geometry import Array
from tracker.registration.record import Registration

MAX_MM = 2.0
# Nearer to a landmark that was used, the distance is a residual of the fit and no independent check.
MIN_APART_MM = 5.0


@dataclass(frozen=True, slots=True, kw_only=True)
class LandmarkCheck:
    """Distance of the tip from the touched landmark.

    Attributes:
        landmark: name of the landmark.
        distance_mm: distance between tip and landmark.
        off_mm: (3,) tip minus landmark, LPS.
        sd_mm: uncertainty of that distance (3-D RMS), from registration and tip.
        max_mm: limit of the distance.
    """

    landmark: str
    distance_mm: float
    off_mm: Array
    sd_mm: float
    max_mm: float

    @property
    def passed(self) -> bool:
        """Return whether the distance is within the limit."""
        return self.distance_mm <= self.max_mm

    def failures(self) -> tuple[RegistrationError, ...]:
        """Return the errors that prevent navigation; empty if the check passes."""
        if self.passed:
            return ()
        left, back, head = self.off_mm
        return (
            RegistrationError(
                "LANDMARK_CHECK_FAILED",
                f"on '{self.landmark}' the tip is displayed {self.distance_mm:.1f} mm off, allowed "
                f"{self.max_mm:g} mm (left {left:+.1f}, back {back:+.1f}, head {head:+.1f} mm)",
                "Touch it again; if the error remains, patient or reference has moved: register again.",
                {
                    "landmark": self.landmark,
                    "distance_mm": self.distance_mm,
                    "allowed_mm": self.max_mm,
                    "left_mm": left,
                    "back_mm": back,
                    "head_mm": head,
                },
            ),
        )


def check_landmark(
    registration: Registration,
    landmark: str,
    landmark_mm: npt.ArrayLike,
    tip_in_anchor_mm: npt.ArrayLike,
    *,
    used_mm: Mapping[str, npt.ArrayLike],
    tip_covariance_mm2: npt.ArrayLike | None = None,
    max_mm: float = MAX_MM,
) -> LandmarkCheck:
    """Compute the distance of the tip (3,) from a landmark (3,) of the CT that was not used.

    `used_mm`: landmarks on the CT used for the registration, by name; empty for other methods.

    Raises:
        RegistrationError: LANDMARK_WAS_USED, or CHECK_INVALID, a number is not finite.
    """
    at = np.asarray(landmark_mm, dtype=np.float64)
    tip = np.asarray(tip_in_anchor_mm, dtype=np.float64)
    if at.shape != (3,) or tip.shape != (3,) or not (np.isfinite(at).all() and np.isfinite(tip).all()):
        raise RegistrationError(
            "CHECK_INVALID",
            "landmark and tip are not three finite numbers each",
            "Give both in mm: the landmark on the CT, the tip in the anchor's frame.",
        )
    for name, place in used_mm.items():
        distance_mm = float(np.linalg.norm(np.asarray(place, dtype=np.float64) - at))
        if name == landmark or distance_mm < MIN_APART_MM:
            raise RegistrationError(
                "LANDMARK_WAS_USED",
                f"'{landmark}' lies {distance_mm:.1f} mm from '{name}', which was used for the registration; "
                f"needed {MIN_APART_MM:g} mm",
                "Check on another landmark: one that was used fits by construction.",
                {"landmark": landmark, "used": name, "apart_mm": distance_mm, "needed_mm": MIN_APART_MM},
            )
    back = registration.anchor_from_vertebra.inverse
    off = back.move_points(tip) - at
    covariance = registration.point_covariance_mm2(at)
    if tip_covariance_mm2 is not None:
        covariance = covariance + np.asarray(tip_covariance_mm2, dtype=np.float64)
    off.setflags(write=False)
    return LandmarkCheck(
        landmark=landmark,
        distance_mm=float(np.linalg.norm(off)),
        off_mm=off,
        sd_mm=float(np.sqrt(np.trace(covariance))),
        max_mm=max_mm,
    )
