"""The paper's overlay: the slice laid translucent over the video, moved until its lines meet the needles.

The software's zoom, focus and tripod are a shift, a turn and a scale of the slice in the image; the two tilts
that are left come from the ruler. So an overlay is a pose: its scale is the distance, its shift the place.
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
from tracker.registration.needles.places import NeedlePlace
from tracker.registration.needles.seen import NeedleSeen
from tracker.registration.needles.view import View

MIN_SCALE, MAX_SCALE = 0.05, 100.0
SHOWN_MM, ALONG_OPEN_PX = 40.0, 1000.0


@dataclass(frozen=True, slots=True, kw_only=True)
class SliceOverlay:
    """Where a person has laid the slice.

    Attributes:
        shift_px: (2,), where in the image the pivot lies: the middle of the needles' places.
        turn_deg: about the line of sight, clockwise in the image, from how the ruler has it.
        scale_px_per_mm: across the line of sight, at the pivot.
        fade_ratio: how much of the slice shows through: 0 none of it, 1 nothing but it.

    Raises:
        InvalidInput: OVERLAY_INVALID.
    """

    shift_px: Array
    turn_deg: float
    scale_px_per_mm: float
    fade_ratio: float = 0.5

    def __post_init__(self) -> None:
        shift = np.array(self.shift_px, dtype=np.float64).reshape(2)
        numbers = np.array([*shift, self.turn_deg, self.scale_px_per_mm, self.fade_ratio])
        if (
            not np.isfinite(numbers).all()
            or not MIN_SCALE <= self.scale_px_per_mm <= MAX_SCALE
            or not 0.0 <= self.fade_ratio <= 1.0
        ):
            raise InvalidInput(
                "OVERLAY_INVALID",
                f"the slice is laid at {self.scale_px_per_mm:g} px a mm, faded to {self.fade_ratio:g}; "
                f"allowed {MIN_SCALE:g} to {MAX_SCALE:g} px a mm and 0 to 1",
                "Lay the slice over the needles again.",
            )
        shift.setflags(write=False)
        object.__setattr__(self, "shift_px", shift)

    def moved(self, by_px: npt.ArrayLike) -> "SliceOverlay":
        """The same, moved by so many pixels (2,)."""
        return dataclasses.replace(self, shift_px=self.shift_px + np.asarray(by_px, dtype=np.float64))

    def turned(self, by_deg: float, about_px: npt.ArrayLike) -> "SliceOverlay":
        """The same, turned clockwise about a point (2,) of the image."""
        about = np.asarray(about_px, dtype=np.float64)
        cosine, sine = np.cos(np.radians(by_deg)), np.sin(np.radians(by_deg))
        arm = self.shift_px - about
        there = about + np.array([cosine * arm[0] - sine * arm[1], sine * arm[0] + cosine * arm[1]])
        turn = (self.turn_deg + by_deg + 180.0) % 360.0 - 180.0
        return dataclasses.replace(self, shift_px=there, turn_deg=turn)

    def scaled(self, by_ratio: float, about_px: npt.ArrayLike) -> "SliceOverlay":
        """The same, enlarged by this factor about a point (2,) of the image."""
        about = np.asarray(about_px, dtype=np.float64)
        return dataclasses.replace(
            self,
            shift_px=about + by_ratio * (self.shift_px - about),
            scale_px_per_mm=self.scale_px_per_mm * by_ratio,
        )

    def faded(self, to_ratio: float) -> "SliceOverlay":
        """The same, showing through this much."""
        return dataclasses.replace(self, fade_ratio=to_ratio)


@dataclass(frozen=True, slots=True, kw_only=True)
class OverlayResidual:
    """How a needle lies beside its line of the overlay.

    Attributes:
        name: of the needle.
        at_bone_px: from the line to the needle's end at the bone, across the line.
        at_head_px: the same at its head.
        rms_px: of both.
        rms_mm: the same at the needle's distance.
    """

    name: str
    at_bone_px: float
    at_head_px: float
    rms_px: float
    rms_mm: float


def first_overlay(places: Sequence[NeedlePlace], camera: CameraModel, view: View) -> SliceOverlay:
    """The slice in the middle of the image, turned and as large as the ruler has it."""
    width, height = camera.size_wh_px
    scale = float(np.mean(np.diag(camera.matrix)[:2])) / view.distance_mm
    _reject_empty(places)
    return SliceOverlay(shift_px=np.array([0.5 * width, 0.5 * height]), turn_deg=0.0, scale_px_per_mm=scale)


def pose_of_overlay(
    overlay: SliceOverlay, places: Sequence[NeedlePlace], camera: CameraModel, view: View
) -> Rigid[Camera, Vertebra]:
    """The pose in which the vertebra looks as the overlay shows it; its two tilts are the ruler's."""
    _reject_empty(places)
    x, y = camera.normalised_from_px(overlay.shift_px.reshape(1, 2))[0]
    sight = np.array([x, y, 1.0]) / np.linalg.norm([x, y, 1.0])
    distance_mm = float(np.mean(np.diag(camera.matrix)[:2])) / overlay.scale_px_per_mm
    # A turn about +z, which looks away from the eye, is clockwise in the image.
    rotation = rotation_from_vector(np.radians(overlay.turn_deg) * sight) @ view.rotation
    pivot = np.mean([one.point_lps_mm for one in places], axis=0)
    return Rigid(rotation=rotation, translation_mm=distance_mm * sight - rotation @ pivot)


def overlay_of_pose(
    pose: Rigid[Camera, Vertebra],
    places: Sequence[NeedlePlace],
    camera: CameraModel,
    view: View,
    *,
    fade_ratio: float = 0.5,
) -> SliceOverlay:
    """The overlay nearest to a pose: what a proposed fit looks like in the hands of the user."""
    pivot = pose.move_points(np.mean([one.point_lps_mm for one in places], axis=0))
    distance_mm = float(np.linalg.norm(pivot))
    sight = pivot / distance_mm
    turn = pose.rotation @ view.rotation.T
    axis = np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
    # The turn about the line of sight that comes nearest to the whole rotation.
    angle = np.arctan2(float(axis @ sight), float(np.trace(turn) - sight @ turn @ sight))
    return SliceOverlay(
        shift_px=camera.px_from_camera(pivot)[0],
        turn_deg=float(np.degrees(angle)),
        scale_px_per_mm=float(np.mean(np.diag(camera.matrix)[:2])) / distance_mm,
        fade_ratio=fade_ratio,
    )


def image_from_slice(pose: Rigid[Camera, Vertebra], reference: ReferenceSlice, camera: CameraModel) -> Array:
    """The homography (3, 3) that lays the slice's pixels (column, row) over the image.

    Exact at the ends of the outer lines; a lens that bends lines moves what is between by its own bend.
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
    places: Sequence[NeedlePlace],
    camera: CameraModel,
    *,
    length_mm: float = 60.0,
    count: int = 16,
) -> Array:
    """Where each needle's planned line runs in the image: (n, count, 2) px, from the bone outwards."""
    steps = np.linspace(0.0, length_mm, count)[:, None]
    lines = [one.point_lps_mm + steps * one.direction_lps for one in places]
    px = camera.px_from_camera(pose.move_points(np.concatenate(lines)))
    return px.reshape(len(places), count, 2)


def overlay_residuals(
    pose: Rigid[Camera, Vertebra],
    places: Sequence[NeedlePlace],
    seen: Sequence[NeedleSeen],
    camera: CameraModel,
) -> tuple[OverlayResidual, ...]:
    """How far each needle lies beside its line; one that leans lies farther off at its head."""
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


def needles_under(
    pose: Rigid[Camera, Vertebra],
    places: Sequence[NeedlePlace],
    camera: CameraModel,
    *,
    sd_px: float = 1.5,
) -> tuple[NeedleSeen, ...]:
    """What a person says who has laid the lines over the needles: that the needles are seen there.

    How far up or down its line a needle begins is not said by that, so it is left open. The result is for
    `register_needles`, with `order_is_sure`.

    Args:
        pose: of the overlay.
        places: of the needles.
        camera: calibrated.
        sd_px: how well a line was laid over its needle.
    """
    return tuple(
        NeedleSeen(entry_px=line[0], head_px=line[-1], across_sd_px=sd_px, along_sd_px=ALONG_OPEN_PX)
        for line in overlay_lines_px(pose, places, camera, length_mm=SHOWN_MM)
    )


def _reject_empty(places: Sequence[NeedlePlace]) -> None:
    if not places:
        raise InvalidInput(
            "NEEDLES_TOO_FEW",
            "0 needles are planned, the slice is laid over 3",
            "Set a landmark for each needle on the CT, or draw the three lines.",
        )
