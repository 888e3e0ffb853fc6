"""Validated poses of one marker, the input of tool calibrations."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.errors import InvalidInput
from tracker.geometry import Array, Camera, Marker, Rigid

# No camera can image a whole marker at a smaller distance, while distances in metres are always smaller.
MIN_DISTANCE_MM = 10.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Poses:
    """Poses of one marker in several images.

    Attributes:
        rotations: (n, 3, 3), camera from marker.
        translations_mm: (n, 3), the marker's centre in the camera's frame.
        covariances: (n, 6, 6) [mm, rad] as in `Seen.pose_covariance`, or None where unknown.
    """

    rotations: Array
    translations_mm: Array
    covariances: Array | None = None

    @classmethod
    def from_rigids(
        cls, poses: Sequence[Rigid[Camera, Marker]], covariances: Sequence[npt.ArrayLike] | None = None
    ) -> "Poses":
        """Return the validated poses, with their covariances if known.

        Raises:
            InvalidInput: POSE_COVARIANCE_INVALID, or POSE_UNIT_SUSPECT where translations seem to be metres.
        """
        rotations = np.array([pose.rotation for pose in poses]).reshape(-1, 3, 3)
        translations = np.array([pose.translation_mm for pose in poses]).reshape(-1, 3)
        _reject_metres(translations)
        return cls(
            rotations=_read_only(rotations),
            translations_mm=_read_only(translations),
            covariances=None if covariances is None else _checked(covariances, len(poses)),
        )

    def __len__(self) -> int:
        return len(self.rotations)

    def of(self, chosen: npt.NDArray[np.bool_] | npt.NDArray[np.int_]) -> "Poses":
        """Return some of the poses, by a mask or by indices."""
        covariances = None if self.covariances is None else self.covariances[chosen]
        return Poses(
            rotations=self.rotations[chosen],
            translations_mm=self.translations_mm[chosen],
            covariances=covariances,
        )

    def points_mm(self, point_in_marker_mm: npt.ArrayLike) -> Array:
        """Return a point (3,) of the marker in the camera's frame at each pose (n, 3)."""
        turned = self.rotations @ np.asarray(point_in_marker_mm, dtype=np.float64)
        return np.asarray(turned + self.translations_mm)

    @property
    def repeats(self) -> npt.NDArray[np.bool_]:
        """Return the mask of exact copies of an earlier pose, as reported when a marker is lost."""
        flat = np.hstack([self.rotations.reshape(-1, 9), self.translations_mm])
        _, first = np.unique(flat, axis=0, return_index=True)
        repeated = np.ones(len(self), dtype=np.bool_)
        repeated[first] = False
        return repeated


def _read_only(array: Array) -> Array:
    array.setflags(write=False)
    return array


def _reject_metres(translations_mm: Array) -> None:
    distances = np.linalg.norm(translations_mm, axis=1)
    near = int((distances < MIN_DISTANCE_MM).sum())
    if not near:
        return
    shown = float(np.median(distances))
    which = "all" if near == len(distances) else f"{near} of {len(distances)}"
    raise InvalidInput(
        "POSE_UNIT_SUSPECT",
        f"in {which} poses the marker is nearer than {MIN_DISTANCE_MM:g} mm to the camera (median "
        f"{shown:.3g} mm), which is impossible; these seem to be metres",
        "Give all translations in one unit, and specify it if it is not mm (m: --unit m).",
        {
            "near": near,
            "poses": len(distances),
            "median_distance_mm": shown,
            "min_distance_mm": MIN_DISTANCE_MM,
            "near_poses": which,
        },
    )


def _checked(covariances: Sequence[npt.ArrayLike], count: int) -> Array:
    one_by_one = [np.asarray(one, dtype=np.float64) for one in covariances]
    # Matrices of different shapes are no array.
    other = next((one for one in one_by_one if one.shape != (6, 6)), None)
    stated = np.zeros((0, 6, 6)) if not count else np.array(one_by_one) if other is None else other
    is_sound = stated.shape == (count, 6, 6) and bool(np.isfinite(stated).all())
    if is_sound:
        # Normalised to a unit diagonal, because mm and radians differ by orders of magnitude.
        sd = np.sqrt(np.abs(np.diagonal(stated, axis1=1, axis2=2)))
        is_sound = bool((sd > 0.0).all())
        scaled = stated / np.where(sd > 0.0, sd, 1.0)[:, :, None] / np.where(sd > 0.0, sd, 1.0)[:, None, :]
        is_sound = is_sound and bool((np.linalg.eigvalsh(scaled) > -1e-6).all())
    if not is_sound:
        raise InvalidInput(
            "POSE_COVARIANCE_INVALID",
            f"the covariances of {count} poses have the shape {stated.shape} or are not positive, "
            f"needed {(count, 6, 6)}",
            "Give each pose its covariance (6, 6) in mm and radians, translation first, or give none.",
            {"shape": stated.shape, "poses": count, "needed_shape": (count, 6, 6)},
        )
    return _read_only(stated)
