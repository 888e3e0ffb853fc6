"""The tip at rest on a landmark: where it is in the anchor's frame, from several images in a row."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tracker.errors import RegistrationError
from tracker.geometry import Array, inverse_covariance, point_covariance_mm2
from tracker.pose import Seen, ToolModel
from tracker.registration.record import Registration

HOLD_STILL = "Hold the tip still on the landmark, with its marker in view, and capture it again."


@dataclass(frozen=True, slots=True, kw_only=True)
class TipInAnchor:
    """The tip in one image.

    Attributes:
        point_mm: (3,) in the frame of the camera, or of the marker on the patient.
        covariance_mm2: (3, 3) of it in that frame: of the marker's pose, of the tip behind it, and of the
            reference's pose.
    """

    point_mm: Array
    covariance_mm2: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class TouchGate:
    """When the tip counts as at rest.

    Attributes:
        images: in a row, in all of which the tip is seen.
        most_spread_mm: RMS distance of the tip from its mean in them.
    """

    images: int = 15
    most_spread_mm: float = 1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Touched:
    """A point that was touched.

    Attributes:
        point_mm: (3,) mean of the tip, in the anchor's frame.
        covariance_mm2: (3, 3) of it. As wide as that of one image: what a marker's pose errs in one place is
            mostly the same in all images that show it there.
        spread_mm: RMS distance of the tip from its mean.
        images: that it was seen in.
    """

    point_mm: Array
    covariance_mm2: Array
    spread_mm: float
    images: int


def tip_in_anchor(tool: ToolModel, seen: Seen, reference: Seen | None) -> TipInAnchor:
    """Where the tip is in one image: before the camera, or beside the marker on the patient if given."""
    pose, tip = seen.camera_from_marker, tool.marker_from_tool.translation_mm
    in_camera = pose.move_points(tip)
    turned = pose.rotation
    covariance = point_covariance_mm2(pose, seen.pose_covariance, tip)
    covariance = covariance + turned @ tool.tip_covariance_mm2 @ turned.T
    if reference is None:
        return TipInAnchor(point_mm=in_camera, covariance_mm2=covariance)
    back = reference.camera_from_marker.inverse
    of_back = inverse_covariance(reference.camera_from_marker, reference.pose_covariance)
    return TipInAnchor(
        point_mm=back.move_points(in_camera),
        covariance_mm2=point_covariance_mm2(back, of_back, in_camera)
        + back.rotation @ covariance @ back.rotation.T,
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class LandmarkDistance:
    """How far the tip on a landmark is from where the plan has the landmark.

    Attributes:
        found_in_vertebra_mm: (3,) where the registration says that the tip is, LPS.
        distance_mm: from the landmark.
        expected_sd_mm: the distance that the stated uncertainty of registration and tip makes likely (3-D
            RMS).
    """

    found_in_vertebra_mm: Array
    distance_mm: float
    expected_sd_mm: float


def distance_from_landmark(
    registration: Registration, touched: Touched, landmark_lps_mm: Array
) -> LandmarkDistance:
    """Hold a registration against a landmark (3,) of the plan that was touched."""
    found = registration.anchor_from_vertebra.inverse.move_points(touched.point_mm)
    variance = np.trace(registration.point_covariance_mm2(landmark_lps_mm))
    return LandmarkDistance(
        found_in_vertebra_mm=found,
        distance_mm=float(np.linalg.norm(found - landmark_lps_mm)),
        expected_sd_mm=float(np.sqrt(variance + np.trace(touched.covariance_mm2))),
    )


def touched(tips: Sequence[TipInAnchor], gate: TouchGate) -> Touched:
    """The point that the tip rested on.

    Raises:
        RegistrationError: TIP_IMAGES_TOO_FEW, TIP_MOVED.
    """
    if len(tips) < gate.images:
        raise RegistrationError(
            "TIP_IMAGES_TOO_FEW",
            f"the tip was seen in {len(tips)} images, needed {gate.images}",
            HOLD_STILL,
            {"images": len(tips), "needed": gate.images},
        )
    points = np.array([tip.point_mm for tip in tips])
    middle = points.mean(axis=0)
    spread_mm = float(np.sqrt(((points - middle) ** 2).sum(axis=1).mean()))
    if not spread_mm <= gate.most_spread_mm:
        raise RegistrationError(
            "TIP_MOVED",
            f"the tip moved by {spread_mm:.2f} mm RMS in {len(tips)} images, "
            f"allowed {gate.most_spread_mm:.2f} mm",
            HOLD_STILL,
            {"spread_mm": spread_mm, "allowed_mm": gate.most_spread_mm},
        )
    return Touched(
        point_mm=middle,
        covariance_mm2=np.mean([tip.covariance_mm2 for tip in tips], axis=0),
        spread_mm=spread_mm,
        images=len(tips),
    )
