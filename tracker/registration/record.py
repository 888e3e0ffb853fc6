"""The registration: pose of the planned vertebra on the patient, and its covariance.

All methods use one record. It is anchored to the camera or to the patient's reference, and is transformed for
each image. The pose in an image (`VertebraPose`) belongs to that image, so video, numbers and 3-D lose it at
the same time.

`tip_jacobian` is stored because the same tip captures the landmarks and drills: its error cancels if the
drill has the orientation of the captures, and doubles if it is reversed. Assuming independence, the stated 95
% region contains 88 to 100 % of the true values; with the Jacobian, 95 to 97 %.
"""

from dataclasses import dataclass, field, replace
from enum import StrEnum

import numpy as np

from tracker.errors import RegistrationError
from tracker.geometry import Anchor, Array, Camera, Reference, Rigid, Vertebra, point_covariance_mm2


class Method(StrEnum):
    """Registration method."""

    NEEDLES = "needles"  # the paper's: three needles on three lines of the reference slice
    POINTS = "points"  # the tool's tip on landmarks of the plan
    SURFACE = "surface"  # points swept over the bone, fitted to its surface
    REHEARSAL = "rehearsal"  # ground truth of a simulated theatre


class AnchoredTo(StrEnum):
    """Anchor of a registration; it is valid only while the patient does not move relative to it."""

    CAMERA = "camera"  # the pose becomes wrong when patient or camera moves
    REFERENCE = "reference"  # the marker fixed to the patient, which both may move with


@dataclass(frozen=True, slots=True, kw_only=True)
class Registration:
    """Pose of the planned vertebra on the patient.

    Attributes:
        method: registration method.
        anchored_to: camera or reference.
        anchor_from_vertebra: from the plan's frame (LPS, mm) to that of the anchor.
        covariance: (6, 6) [mm, rad] of `anchor_from_vertebra`, as in `point_covariance_mm2`: translation
            first, then a small rotation about the origin of the vertebra frame (that of the CT), on the axes
            of the anchor. Symmetric. About the anchor's origin instead, the stated error is wrong by the
            lever between both.
        tip_jacobian: (6, 3), derivative of `anchor_from_vertebra` with respect to the calibrated tip
            position; if the same tool registers and drills, much of that error cancels. 0 if no tip was used.
        tool: the tool with that tip; empty if none.
        tracking_covariance_mm2: (3, 3), of the tip in the anchor frame from the poses of the markers alone,
            at the best capture: the tracking error of a drill seen equally well. 0 if not known.

    Raises:
        RegistrationError: REGISTRATION_COVARIANCE_INVALID, the covariance is not finite or not positive
            semidefinite.
    """

    method: Method
    anchored_to: AnchoredTo
    anchor_from_vertebra: Rigid[Anchor, Vertebra]
    covariance: Array
    tip_jacobian: Array = field(default_factory=lambda: np.zeros((6, 3)))
    tool: str = ""
    tracking_covariance_mm2: Array = field(default_factory=lambda: np.zeros((3, 3)))

    @classmethod
    def known_to_camera(cls, camera_from_vertebra: Rigid[Camera, Vertebra]) -> "Registration":
        """Return the exact pose of a simulated theatre, anchored to the camera."""
        return cls(
            method=Method.REHEARSAL,
            anchored_to=AnchoredTo.CAMERA,
            anchor_from_vertebra=Rigid(
                rotation=camera_from_vertebra.rotation, translation_mm=camera_from_vertebra.translation_mm
            ),
            covariance=np.zeros((6, 6)),
        )

    @classmethod
    def known_to_reference(cls, reference_from_vertebra: Rigid[Reference, Vertebra]) -> "Registration":
        """Return the exact pose of a simulated theatre, anchored to the patient's reference."""
        return cls(
            method=Method.REHEARSAL,
            anchored_to=AnchoredTo.REFERENCE,
            anchor_from_vertebra=Rigid(
                rotation=reference_from_vertebra.rotation,
                translation_mm=reference_from_vertebra.translation_mm,
            ),
            covariance=np.zeros((6, 6)),
        )

    def __post_init__(self) -> None:
        covariance = np.array(self.covariance, dtype=np.float64).reshape(6, 6)
        if not np.isfinite(covariance).all() or np.linalg.eigvalsh(covariance).min() < -1e-9:
            raise RegistrationError(
                "REGISTRATION_COVARIANCE_INVALID",
                "the uncertainty of the registration is not a finite covariance",
                "Register again.",
            )
        covariance = 0.5 * (covariance + covariance.T)
        slope = np.array(self.tip_jacobian, dtype=np.float64).reshape(6, 3)
        tracking = np.array(self.tracking_covariance_mm2, dtype=np.float64).reshape(3, 3)
        if not np.isfinite(tracking).all() or np.linalg.eigvalsh(tracking).min() < -1e-9:
            raise RegistrationError(
                "REGISTRATION_COVARIANCE_INVALID",
                "the uncertainty of tracking at the registration is not a finite covariance",
                "Register again.",
            )
        for name, array in (
            ("covariance", covariance),
            ("tip_jacobian", slope),
            ("tracking_covariance_mm2", tracking),
        ):
            array.setflags(write=False)
            object.__setattr__(self, name, array)

    def without_tip_error(self, tip_covariance_mm2: Array) -> "Registration":
        """Return the registration as it would be if the tip that captured it were known exactly.

        Args:
            tip_covariance_mm2: (3, 3), of the calibration of the tip, in the frame of `tip_jacobian`.
        """
        of_tip = self.tip_jacobian @ np.asarray(tip_covariance_mm2) @ self.tip_jacobian.T
        # Clipped, because rounding or a newer calibration can leave a slightly negative variance.
        values, vectors = np.linalg.eigh(self.covariance - of_tip)
        return replace(self, covariance=(vectors * np.maximum(values, 0.0)) @ vectors.T)

    def point_covariance_mm2(self, point_in_vertebra_mm: Array) -> Array:
        """Return the covariance (3, 3) of a point of the plan, in the anchor frame."""
        return point_covariance_mm2(self.anchor_from_vertebra, self.covariance, point_in_vertebra_mm)
