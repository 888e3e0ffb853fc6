"""The paper's overlay: the slice over the video, moved until its lines coincide with the needles.

Instead of the paper's zoom, focus and tripod, the slice is shifted, rotated and scaled in the image; the two
remaining tilts come from the ruler. An overlay therefore determines a pose: its scale gives the distance, its
shift the position.
"""

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from tracker.camera import CameraModel
from tracker.errors import InvalidInput
from tracker.geometry import Array, Camera, Rigid, Vertebra, rotation_from_vector
from tracker.plan import ReferenceSlice
from tracker.registration.needles.observation import NeedleObservation
from tracker.registration.needles.planned import PlannedNeedle
from tracker.registration.needles.view_prior import ViewPrior

MIN_SCALE, MAX_SCALE = 0.05, 100.0
SHOWN_MM, ALONG_OPEN_PX = 40.0, 1000.0


@dataclass(frozen=True, slots=True, kw_only=True)
class SliceOverlay:
    """Position of the slice in the image.

    Attributes:
        shift_px: (2,), image position of the pivot: the centroid of the planned needles.
        rotation_deg: rotation about the line of sight, clockwise in the image, relative to the view prior.
        scale_px_per_mm: perpendicular to the line of sight, at the pivot.
        fade_ratio: opacity of the slice, 0..1.

    Raises:
        InvalidInput: OVERLAY_INVALID.
    """

    shift_px: Array
    rotation_deg: float
    scale_px_per_mm: float
    fade_ratio: float = 0.5

    def __post_init__(self) -> None:
        shift = np.array(self.shift_px, dtype=np.float64).reshape(2)
        numbers = np.array([*shift, self.rotation_deg, self.scale_px_per_mm, self.fade_ratio])
        if (
            not np.isfinite(numbers).all()
            or not MIN_SCALE <= self.scale_px_per_mm <= MAX_SCALE
            or not 0.0 <= self.fade_ratio <= 1.0
        ):
            raise InvalidInput(
                "OVERLAY_INVALID",
                f"the slice has scale {self.scale_px_per_mm:g} px/mm and opacity {self.fade_ratio:g}; "
                f"allowed {MIN_SCALE:g} to {MAX_SCALE:g} px/mm and 0 to 1",
                "Align the slice with the needles again.",
                {
                    "scale_px_per_mm": self.scale_px_per_mm,
                    "fade_ratio": self.fade_ratio,
                    "min_scale": MIN_SCALE,
                    "max_scale": MAX_SCALE,
                },
            )
        shift.setflags(write=False)
        object.__setattr__(self, "shift_px", shift)

    def moved(self, by_px: npt.ArrayLike) -> "SliceOverlay":
        """Return the overlay shifted by pixels (2,)."""
        return dataclasses.replace(self, shift_px=self.shift_px + np.asarray(by_px, dtype=np.float64))

    def turned(self, by_deg: float, about_px: npt.ArrayLike) -> "SliceOverlay":
        """Return the overlay rotated clockwise about a point (2,) of the image."""
        about = np.asarray(about_px, dtype=np.float64)
        cosine, sine = np.cos(np.radians(by_deg)), np.sin(np.radians(by_deg))
        arm = self.shift_px - about
        there = about + np.array([cosine * arm[0] - sine * arm[1], sine * arm[0] + cosine * arm[1]])
        turn = (self.rotation_deg + by_deg + 180.0) % 360.0 - 180.0
        return dataclasses.replace(self, shift_px=there, rotation_deg=turn)

    def scaled(self, by_ratio: float, about_px: npt.ArrayLike) -> "SliceOverlay":
        """Return the overlay scaled about a point (2,) of the image."""
        about = np.asarray(about_px, dtype=np.float64)
        return dataclasses.replace(
            self,
            shift_px=about + by_ratio * (self.shift_px - about),
            scale_px_per_mm=self.scale_px_per_mm * by_ratio,
        )

    def faded(self, to_ratio: float) -> "SliceOverlay":
        """Return the overlay with another opacity."""
        return dataclasses.replace(self, fade_ratio=to_ratio)


@dataclass(frozen=True, slots=True, kw_only=True)
class OverlayResidual:
    """Distance of a needle from its line of the overlay.

    Attributes:
        name: of the needle.
        at_bone_px: across the line, at the end at the bone.
        at_head_px: the same at its head.
        rms_px: of both.
        rms_mm: the same at the needle's distance.
    """

    name: str
    at_bone_px: float
    at_head_px: float
    rms_px: float
    rms_mm: float


def first_overlay(places: Sequence[PlannedNeedle], camera: CameraModel, view: ViewPrior) -> SliceOverlay:
    """Return the slice at the image centre, rotated and scaled by the view prior."""
    width, height = camera.size_wh_px
    scale = float(np.mean(np.diag(camera.matrix)[:2])) / view.distance_mm
    _reject_empty(places)
    return SliceOverlay(
        shift_px=np.array([0.5 * width, 0.5 * height]), rotation_deg=0.0, scale_px_per_mm=scale
    )


def pose_of_overlay(
    overlay: SliceOverlay, places: Sequence[PlannedNeedle], camera: CameraModel, view: ViewPrior
) -> Rigid[Camera, Vertebra]:
    """Return the pose that an overlay determines; its two tilts are those of the view prior."""
    _reject_empty(places)
    x, y = camera.normalised_from_px(overlay.shift_px.reshape(1, 2))[0]
    sight = np.array([x, y, 1.0]) / np.linalg.norm([x, y, 1.0])
    distance_mm = float(np.mean(np.diag(camera.matrix)[:2])) / overlay.scale_px_per_mm
    # A positive rotation about +z, which points away from the camera, is clockwise in the image.
    rotation = rotation_from_vector(np.radians(overlay.rotation_deg) * sight) @ view.rotation
    pivot = np.mean([one.point_lps_mm for one in places], axis=0)
    return Rigid(rotation=rotation, translation_mm=distance_mm * sight - rotation @ pivot)


def overlay_of_pose(
    pose: Rigid[Camera, Vertebra],
    places: Sequence[PlannedNeedle],
    camera: CameraModel,
    view: ViewPrior,
    *,
    fade_ratio: float = 0.5,
) -> SliceOverlay:
    """Return the overlay closest to a pose, to display a proposed fit."""
    pivot = pose.move_points(np.mean([one.point_lps_mm for one in places], axis=0))
    distance_mm = float(np.linalg.norm(pivot))
    sight = pivot / distance_mm
    turn = pose.rotation @ view.rotation.T
    axis = np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
    # The rotation about the line of sight closest to the full rotation.
    angle = np.arctan2(float(axis @ sight), float(np.trace(turn) - sight @ turn @ sight))
    return SliceOverlay(
        shift_px=camera.px_from_camera(pivot)[0],
        rotation_deg=float(np.degrees(angle)),
        scale_px_per_mm=float(np.mean(np.diag(camera.matrix)[:2])) / distance_mm,
        fade_ratio=fade_ratio,
    )


def image_from_slice(pose: Rigid[Camera, Vertebra], reference: ReferenceSlice, camera: CameraModel) -> Array:
    """Return the homography (3, 3) from slice pixels (column, row) to the image.

    Exact at the ends of the outer lines; between them lens distortion is neglected.
    """
    lines = {line.name: line for line in reference.lines}
    left, right = lines["left"], lines["right"]
    slice_px = np.concatenate([left.ends_px, right.ends_px])
    points = pose.move_points(np.concatenate([left.ends_lps_mm, right.ends_lps_mm]))
    image_px = camera.px_from_camera(points)
    return np.asarray(
        cv2.getPerspectiveTransform(slice_px.astype(np.float32), image_px.astype(np.float32)),
        dtype=np.float64,
    )


def overlay_lines_px(
    pose: Rigid[Camera, Vertebra],
    places: Sequence[PlannedNeedle],
    camera: CameraModel,
    *,
    length_mm: float = 60.0,
    count: int = 16,
) -> Array:
    """Return each needle's planned line in the image: (n, count, 2) px, from the bone outwards."""
    steps = np.linspace(0.0, length_mm, count)[:, None]
    lines = [one.point_lps_mm + steps * one.direction_lps for one in places]
    px = camera.px_from_camera(pose.move_points(np.concatenate(lines)))
    return px.reshape(len(places), count, 2)


def overlay_residuals(
    pose: Rigid[Camera, Vertebra],
    places: Sequence[PlannedNeedle],
    seen: Sequence[NeedleObservation],
    camera: CameraModel,
) -> tuple[OverlayResidual, ...]:
    """Return the distance of each needle from its line; a tilted one has a larger distance at its head."""
    out = []
    for place, needle, line in zip(places, seen, overlay_lines_px(pose, places, camera), strict=True):
        along = (line[-1] - line[0]) / np.linalg.norm(line[-1] - line[0])
        beside = np.array([-along[1], along[0]])
        bone, head = (float((end - line[0]) @ beside) for end in (needle.entry_px, needle.head_px))
        rms = float(np.hypot(bone, head) / np.sqrt(2.0))
        depth = float(pose.move_points(place.point_lps_mm)[2])
        out.append(
            OverlayResidual(
                name=place.name,
                at_bone_px=bone,
                at_head_px=head,
                rms_px=rms,
                rms_mm=rms * depth / float(np.mean(np.diag(camera.matrix)[:2])),
            )
        )
    return tuple(out)


def needles_from_overlay(
    pose: Rigid[Camera, Vertebra],
    places: Sequence[PlannedNeedle],
    camera: CameraModel,
    *,
    sd_px: float = 1.5,
) -> tuple[NeedleObservation, ...]:
    """Return the needle observations implied by an overlay that a person has aligned.

    The position along each line is undetermined and left open. Pass the result to `register_needles` with
    `order_is_sure`.

    Args:
        pose: of the overlay.
        places: planned needles.
        camera: calibrated.
        sd_px: standard deviation of the alignment of a line with its needle.
    """
    return tuple(
        NeedleObservation(entry_px=line[0], head_px=line[-1], across_sd_px=sd_px, along_sd_px=ALONG_OPEN_PX)
        for line in overlay_lines_px(pose, places, camera, length_mm=SHOWN_MM)
    )


def _reject_empty(places: Sequence[PlannedNeedle]) -> None:
    if not places:
        raise InvalidInput(
            "NEEDLES_TOO_FEW",
            "0 needles are planned, the slice is aligned with 3",
            "Set a landmark for each needle on the CT, or draw the three lines.",
        )
