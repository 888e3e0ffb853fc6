"""Whitened residuals of a pose against needles in the image, the view prior and touched points."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tracker.camera import CameraModel
from tracker.geometry import Array, Camera, Rigid, Vertebra, rotation_from_vector, skew, vector_from_rotation
from tracker.registration.needles.observation import OCCLUDED_MM, OCCLUDED_SD_MM, NeedleObservation
from tracker.registration.needles.planned import PlannedNeedle
from tracker.registration.needles.view_prior import ViewPrior

NEAREST_MM = 20.0
LONGEST_ARM_MM = 80.0


@dataclass(frozen=True, slots=True, kw_only=True)
class NeedleProblem:
    """Data of the pose fit, prepared once.

    Attributes:
        places: (n) planned needles.
        seen: (n) the same needles in the image.
        entries: (n, 2) ends at the bone, in undistorted px.
        heads: (n, 2) other ends, likewise.
        focal_px: (2,), and middle_px (2,), of the undistorted camera.
        view: prior from the ruler.
        middle_mm: (3,), LPS, centroid of the planned needles; the pose is parametrised there.
    """

    places: tuple[PlannedNeedle, ...]
    seen: tuple[NeedleObservation, ...]
    entries: Array
    heads: Array
    focal_px: Array
    middle_px: Array
    view: ViewPrior
    middle_mm: Array

    @classmethod
    def of(
        cls,
        places: Sequence[PlannedNeedle],
        seen: Sequence[NeedleObservation],
        camera: CameraModel,
        view: ViewPrior,
    ) -> "NeedleProblem":
        """Undistort the observations and prepare the data."""
        focal, middle = np.diag(camera.matrix)[:2], camera.matrix[:2, 2]
        entries = camera.normalised_from_px([one.entry_px for one in seen]) * focal + middle
        heads = camera.normalised_from_px([one.head_px for one in seen]) * focal + middle
        return cls(
            places=tuple(places),
            seen=tuple(seen),
            entries=entries,
            heads=heads,
            focal_px=focal,
            middle_px=middle,
            view=view,
            middle_mm=np.mean([one.point_lps_mm for one in places], axis=0),
        )

    def project(self, points_mm: Array) -> Array:
        """Project points (n, 3) of the camera frame to undistorted pixels (n, 2)."""
        depth = np.maximum(points_mm[:, 2:], NEAREST_MM)
        return np.asarray(points_mm[:, :2] / depth * self.focal_px + self.middle_px)

    def slope(self, points_mm: Array) -> Array:
        """Return the Jacobian (n, 2, 3) of the projection at points (n, 3) of the camera frame."""
        depth = np.maximum(points_mm[:, 2], NEAREST_MM)
        out = np.zeros((len(points_mm), 2, 3))
        for axis in range(2):
            out[:, axis, axis] = self.focal_px[axis] / depth
            out[:, axis, 2] = -self.focal_px[axis] * points_mm[:, axis] / depth**2
        return out

    def leaning(self, pose: Rigid[Camera, Vertebra]) -> Array:
        """Return unit directions (n, 3), vertebra frame: as planned, projected into their image planes."""
        start = np.column_stack([(self.entries - self.middle_px) / self.focal_px, np.ones(len(self.seen))])
        end = np.column_stack([(self.heads - self.middle_px) / self.focal_px, np.ones(len(self.seen))])
        normal = np.cross(start, end)
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        planned = pose.rotate_directions(np.stack([one.direction_lps for one in self.places]))
        leaned = planned - np.einsum("ij,ij->i", planned, normal)[:, None] * normal
        length = np.linalg.norm(leaned, axis=1, keepdims=True)
        leaned = np.where(length > 0.1, leaned / np.maximum(length, 1e-9), planned)
        return np.asarray(pose.inverse.rotate_directions(leaned))


class NeedleResiduals:
    """Whitened residuals about one pose, where their covariance is evaluated once.

    Args:
        task: the data.
        about: the pose. A step (6) from a pose is a shift in mm of the needles' centroid, then a small
            rotation vector in radians multiplied from the left, both in the camera frame.
    """

    def __init__(self, task: NeedleProblem, about: Rigid[Camera, Vertebra]) -> None:
        self.task = task
        self.about = about
        self._points = np.stack([one.point_lps_mm for one in task.places])
        line = task.heads - task.entries
        self._length = np.linalg.norm(line, axis=1)
        self._along = line / self._length[:, None]
        self._across = np.stack([-self._along[:, 1], self._along[:, 0]], axis=1)
        hidden = np.array([0.0 if one.entry_is_seen else OCCLUDED_MM for one in task.seen])
        self._shown = self._points + hidden[:, None] * task.leaning(about)
        self._arms = self._arms_mm()
        self._far = self._points + self._arms[:, None] * np.stack([one.direction_lps for one in task.places])
        self._spread = self._joint_spread()
        root = np.linalg.cholesky(self._spread)
        self._whiten = np.linalg.inv(root)
        # The log determinant, because a larger covariance must not make a pose more likely.
        self.log_spread = float(2.0 * np.log(np.diag(root)).sum())
        self._turn_whiten = np.linalg.cholesky(np.linalg.inv(task.view.rotation_covariance)).T

    def moved(self, pose: Rigid[Camera, Vertebra], step: Array) -> Rigid[Camera, Vertebra]:
        """Apply a step (6) to a pose: a shift of the centroid, and a rotation about it."""
        rotation = rotation_from_vector(step[3:]) @ pose.rotation
        middle = pose.move_points(self.task.middle_mm) + step[:3]
        return Rigid(rotation=rotation, translation_mm=middle - rotation @ self.task.middle_mm)

    def needles_px(self, pose: Rigid[Camera, Vertebra]) -> Array:
        """Return (n, 3) px: the end at the bone along and across the needle, and the head across it."""
        shown = self.task.project(pose.move_points(self._shown)) - self.task.entries
        entries = self.task.project(pose.move_points(self._points)) - self.task.entries
        heads = self.task.project(pose.move_points(self._far)) - self.task.heads
        rows = ((shown, self._along), (entries, self._across), (heads, self._across))
        return np.stack([np.einsum("ij,ij->i", off, direction) for off, direction in rows], axis=1)

    def touched_mm(self, pose: Rigid[Camera, Vertebra]) -> Array:
        """Return (m, 3) mm, camera frame: predicted minus captured position of the touched points."""
        touched = self.task.view.touched
        off = [pose.move_points(one.point_lps_mm) - one.point_in_camera_mm for one in touched]
        return np.array(off).reshape(-1, 3)

    def misfits(self, pose: Rigid[Camera, Vertebra]) -> Array:
        """Return the squared Mahalanobis distance (n + m) of each needle, then of each touched point."""
        rows = np.concatenate([self.needles_px(pose), self.touched_mm(pose)])
        blocks = [self._spread[3 * i : 3 * i + 3, 3 * i : 3 * i + 3] for i in range(len(rows))]
        return np.array([row @ np.linalg.solve(block, row) for row, block in zip(rows, blocks, strict=True)])

    def ruler_residuals(self, pose: Rigid[Camera, Vertebra]) -> Array:
        """Return the whitened residuals (4) of rotation and distance relative to the view prior."""
        view = self.task.view
        turn = vector_from_rotation(pose.rotation @ view.rotation.T)
        distance = float(np.linalg.norm(pose.move_points(self.task.middle_mm)))
        return np.append(self._turn_whiten @ turn, (distance - view.distance_mm) / view.distance_sd_mm)

    def residuals(self, pose: Rigid[Camera, Vertebra]) -> Array:
        """Return all whitened residuals: the four of the view prior, then needles and touched points."""
        rows = np.concatenate([self.needles_px(pose), self.touched_mm(pose)]).ravel()
        return np.concatenate([self.ruler_residuals(pose), self._whiten @ rows])

    def jacobian(self, pose: Rigid[Camera, Vertebra]) -> Array:
        """Return the Jacobian (4 + 3n + 3m, 6) of the residuals with respect to a step."""
        task = self.task
        middle = pose.move_points(task.middle_mm)
        ruler = np.zeros((4, 6))
        ruler[:3, 3:] = self._turn_whiten @ _follows_turn(
            vector_from_rotation(pose.rotation @ task.view.rotation.T)
        )
        ruler[3, :3] = middle / np.linalg.norm(middle) / task.view.distance_sd_mm
        entries, heads = pose.move_points(self._points), pose.move_points(self._far)
        at_bone = task.slope(entries) @ _follow(entries - middle)
        at_head = task.slope(heads) @ _follow(heads - middle)
        directions = ((at_bone, self._along), (at_bone, self._across), (at_head, self._across))
        needles = np.stack(
            [np.einsum("nij,ni->nj", slope, direction) for slope, direction in directions], axis=1
        )
        tips = [pose.move_points(one.point_lps_mm) - middle for one in task.view.touched]
        touched = _follow(np.array(tips).reshape(-1, 3))
        rows = np.concatenate([needles.reshape(-1, 6), touched.reshape(-1, 6)])
        return np.concatenate([ruler, self._whiten @ rows])

    def pose_covariance(self, covariance: Array) -> Array:
        """Transform the covariance (6, 6) [mm, rad] of a step from `about` to that of the pose."""
        carry = np.eye(6)
        carry[:3, 3:] = skew(self.about.rotation @ self.task.middle_mm)
        return np.asarray(carry @ covariance @ carry.T)

    def _arms_mm(self) -> Array:
        """Return the distance along each needle at which the line of its head is compared."""
        directions = self.about.rotate_directions(np.stack([one.direction_lps for one in self.task.places]))
        slope = self.task.slope(self.about.move_points(self._points))
        px_per_mm = np.linalg.norm(np.einsum("nij,nj->ni", slope, directions), axis=1)
        return np.asarray(np.minimum(self._length / np.maximum(px_per_mm, 1e-6), LONGEST_ARM_MM))

    def _joint_spread(self) -> Array:
        """Return the joint covariance (3n + 3m, 3n + 3m) of needles and touched points.

        A needle placed beside its landmark is displaced equally in the image and under the tip, so both share
        that error if they have the same name.
        """
        task, touched = self.task, self.task.view.touched
        size = 3 * (len(task.places) + len(touched))
        spread = np.zeros((size, size))
        for m, one in enumerate(touched):
            start = 3 * (len(task.places) + m)
            spread[start : start + 3, start : start + 3] = one.covariance_mm2
        for n, (moved, image) in enumerate(self._needle_spreads()):
            place = task.places[n]
            rows = np.zeros((size, 5))
            rows[3 * n : 3 * n + 3] = moved
            for m, one in enumerate(touched):
                if one.name == place.name:
                    start = 3 * (len(task.places) + m)
                    rows[start : start + 3, :3] = self.about.rotation
            put = np.eye(5)
            put[:3, :3] = place.covariance_mm2
            spread += rows @ put @ rows.T
            spread[3 * n : 3 * n + 3, 3 * n : 3 * n + 3] += image
        return spread

    def _needle_spreads(self) -> list[tuple[Array, Array]]:
        """Return Jacobians (3, 5) of a needle's residuals by placement and lean, and noise (3, 3)."""
        task, turn = self.task, self.about.rotation
        at_bone = task.slope(self.about.move_points(self._points)) @ turn
        at_head = task.slope(self.about.move_points(self._far)) @ turn
        px_per_mm = np.linalg.norm(np.einsum("nij,nj->ni", at_bone, task.leaning(self.about)), axis=1)
        out = []
        for n, (place, seen) in enumerate(zip(task.places, task.seen, strict=True)):
            # Placement and lean of the needle displace both ends.
            lean = np.radians(place.direction_sd_deg) * self._arms[n]
            beside = np.linalg.svd(place.direction_lps[None])[2][1:]
            moved = np.zeros((3, 5))
            moved[0, :3] = self._along[n] @ at_bone[n]
            moved[1, :3] = self._across[n] @ at_bone[n]
            moved[2, :3] = self._across[n] @ at_head[n]
            moved[2, 3:] = lean * (self._across[n] @ at_head[n] @ beside.T)
            rim_px = 0.0 if seen.entry_is_seen else OCCLUDED_SD_MM * px_per_mm[n]
            along = seen.along_sd_px**2 + rim_px**2
            image = np.diag([along, seen.across_sd_px**2, seen.across_sd_px**2])
            out.append((moved, image))
        return out


def _follow(arms: Array) -> Array:
    """Return the Jacobian (n, 3, 6) of points at these arms (n, 3) from the centroid."""
    out = np.zeros((len(arms), 3, 6))
    out[:, :, :3] = np.eye(3)
    for n, arm in enumerate(arms):
        out[n, :, 3:] = -skew(arm)
    return out


def _follows_turn(vector: Array) -> Array:
    """Return the derivative (3, 3) of a rotation vector by a left-multiplied rotation, to second order."""
    cross = skew(vector)
    return np.asarray(np.eye(3) - 0.5 * cross + cross @ cross / 12.0)
