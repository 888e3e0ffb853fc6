"""Estimate the readout time of a rolling shutter from a board that is moved quickly in front of the camera.

Rows are read sequentially, so a moving board is sheared or stretched by its velocity times the time between
its rows. All poses of a burst of images and one readout time are fitted together (Gauss-Newton); the velocity
of the board is computed from the poses of neighbouring images. A shear is partly equivalent to a tilt: only
the component orthogonal to the pose derivatives determines the readout time, and the standard deviation
accounts for it.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from tracker.camera.calibration.fit import board_pose
from tracker.camera.detection import BoardView
from tracker.camera.model import CameraModel
from tracker.errors import CalibrationError
from tracker.geometry import Array, rotation_from_vector, vector_from_rotation

# | threshold | unit | source | what breaks when it moves |
# |---|---|---|---|
# | MIN_IMAGES | 1 | to estimate the sd between images | lower: a few outliers decide |
# | MAX_GAP_S | s | a hand reverses in a quarter of a second | higher: speeds between images are unreliable |
# | MIN_SPEED_PX_S | px/s | 16 ms shift a board's far rows by 2 px | lower: the remedy is vague |
# | MIN_WAYS | images | the bias of a bent board cancels both ways | lower: its shape biases the time |
# | MAX_SD_MS | ms | 0.1 mm of a tip at 100 mm/s | higher: the correction is useless |
# | MAX_ODD_RATIO | 1 | of the median residual | higher: an outlier view decides; lower: blur is rejected |
# | FLOOR_MS, FLOOR_RATIO | ms, 1 | clock of a driver; speeds from five images | lower: sd too small |
MIN_IMAGES, MIN_WAYS = 12, 4
MAX_GAP_S = 0.14
MIN_SPEED_PX_S, MAX_SD_MS = 150.0, 1.0
MAX_ODD_RATIO = 3.0
FLOOR_MS, FLOOR_RATIO = 0.05, 0.01
MAX_ROUNDS, CONVERGED_S = 25, 5e-6
STEP = np.array([1e-5, 1e-5, 1e-5, 1e-2, 1e-2, 1e-2])
STEP_S = 1e-4
MOVE = (
    "Move it quickly to and fro, sideways and up and down, about twice a second, and keep it in the picture."
)


@dataclass(frozen=True, slots=True, kw_only=True)
class TimedView:
    """A board in one image.

    Attributes:
        at_s: capture time of the image.
        view: the board's points in it.
    """

    at_s: float
    view: BoardView


@dataclass(frozen=True, slots=True, kw_only=True)
class ReadoutEstimate:
    """A measured readout time.

    Attributes:
        readout_ms: time from the readout of the first row to that of the last; about 0 for a global shutter.
        sd_ms: standard deviation of the readout time.
        images: number of images in use.
        speed_px_s: median speed of the board in them.
        rms_px: RMS of the residuals.
    """

    readout_ms: float
    sd_ms: float
    images: int
    speed_px_s: float
    rms_px: float

    @property
    def used_ms(self) -> float:
        """Return the time to track with: 0 (global shutter) within two standard deviations of 0."""
        return self.readout_ms if self.readout_ms > 2.0 * self.sd_ms else 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class _Image:
    """One image (n points).

    Attributes:
        pose_step: (6, 2 n), pseudo-inverse of the pose Jacobian.
        by_readout: (2 n,) [px/s], derivative of the points by the readout time.
        observable: the component of `by_readout` orthogonal to all pose derivatives.
        residual: (2 n,) [px], found - predicted.
        flow_px_s: (2,), motion of the board.
    """

    pose_step: Array
    by_readout: Array
    observable: Array
    residual: Array
    flow_px_s: Array


def estimate_readout(views: Sequence[TimedView], camera: CameraModel) -> ReadoutEstimate:
    """Return the readout time of a calibrated camera from views of a moving board in successive images.

    Args:
        views: in the order of their times.
        camera: calibrated, for this size of image.

    Raises:
        CalibrationError: READOUT_TOO_FEW_IMAGES, READOUT_TOO_SLOW, READOUT_ONE_WAY, READOUT_UNOBSERVABLE,
            READOUT_IMPOSSIBLE.
    """
    used = [one for one in views if board_pose(one.view, camera.matrix, camera.distortion) is not None]
    burst, readout_s = _fitted(used, camera)
    typical = float(np.median([_rms(one.residual) for one in burst.values()])) if burst else 0.0
    odd = {index for index, one in burst.items() if _rms(one.residual) > MAX_ODD_RATIO * typical}
    if odd:
        used = [one for index, one in enumerate(used) if index not in odd]
        burst, readout_s = _fitted(used, camera)
    if len(burst) < MIN_IMAGES:
        raise CalibrationError(
            "READOUT_TOO_FEW_IMAGES",
            f"the moving board was found in {len(burst)} images with neighbours within "
            f"{1000.0 * MAX_GAP_S:.0f} ms, needed {MIN_IMAGES}",
            "Move the board a little slower or use more light, so that it is sharp, and keep all of it in "
            "the picture.",
            {"images": len(burst), "min_images": MIN_IMAGES, "gap_ms": 1000.0 * MAX_GAP_S},
        )
    images = list(burst.values())
    estimate = _estimate(images, readout_s)
    _reject_motion(images, estimate)
    _reject_uncertain(estimate)
    _reject_impossible(estimate, min(b.at_s - a.at_s for a, b in pairwise(used)))
    return estimate


def _fitted(views: Sequence[TimedView], camera: CameraModel) -> tuple[dict[int, _Image], float]:
    """Fit poses and readout time together; return the images in use by index, and the time [s]."""
    poses = [board_pose(one.view, camera.matrix, camera.distortion) for one in views]
    placed = [np.concatenate(pose) for pose in poses if pose is not None]
    around = {index: near for index in range(len(views)) if len(near := _neighbours(views, index)) >= 3}
    readout_s, images = 0.0, {}
    for _ in range(MAX_ROUNDS):
        motions = {index: _motion(views, placed, index, near) for index, near in around.items()}
        # A pose without neighbours on both sides is used only for the motion of others.
        images = {
            index: _image(views[index], placed[index], motion, readout_s, camera)
            for index, motion in motions.items()
        }
        inner = {index: one for index, one in images.items() if _is_inner(index, around[index])}
        if not inner:
            return {}, 0.0
        information = sum(float(one.observable @ one.observable) for one in inner.values())
        step_s = sum(float(one.observable @ one.residual) for one in inner.values()) / max(information, 1e-12)
        for index, one in images.items():
            left = one.residual - one.by_readout * step_s
            placed[index] = _moved(placed[index], one.pose_step @ left)
        readout_s += step_s
        images = inner
        if abs(step_s) < CONVERGED_S:
            break
    return images, readout_s


def _neighbours(views: Sequence[TimedView], index: int) -> list[int]:
    """Return the indexes of the image and of up to two on either side that are near in time."""
    near = [index]
    for way in (-1, 1):
        last = index
        for place in (index + way, index + 2 * way):
            if not 0 <= place < len(views) or abs(views[place].at_s - views[last].at_s) > MAX_GAP_S:
                break
            near.append(place)
            last = place
    return sorted(near)


def _is_inner(index: int, near: Sequence[int]) -> bool:
    return near[0] < index < near[-1]


def _motion(views: Sequence[TimedView], poses: Sequence[Array], index: int, near: Sequence[int]) -> Array:
    """Return velocity and half the acceleration (2, 6) [rad, mm by s], by a polynomial fit to near poses."""
    inverse = rotation_from_vector(poses[index][:3]).T
    apart = np.array(
        [
            [
                *vector_from_rotation(rotation_from_vector(poses[one][:3]) @ inverse),
                *(poses[one][3:] - poses[index][3:]),
            ]
            for one in near
        ]
    )
    times_s = np.array([views[one].at_s - views[index].at_s for one in near])
    scale_s = float(np.abs(times_s).max())
    coefficients = np.linalg.solve(np.vander(times_s / scale_s, increasing=True), apart)
    return np.asarray(coefficients[1:3] / scale_s ** np.array([[1.0], [2.0]]))


def _image(one: TimedView, pose: Array, motion: Array, readout_s: float, camera: CameraModel) -> _Image:
    points = one.view.object_points_mm
    # A pose refers to the readout time of the middle row.
    place = one.view.image_points_px[:, 1:] / camera.size_wh_px[1] - 0.5

    def projected(at: Array, seconds: float) -> Array:
        moved = motion[0] * (place * seconds) + motion[1] * (place * seconds) ** 2
        arms = points @ rotation_from_vector(at[:3]).T
        first = np.cross(moved[:, :3], arms)
        turned = arms + first + 0.5 * np.cross(moved[:, :3], first)
        return np.asarray(camera.px_from_camera(turned + at[3:] + moved[:, 3:]).ravel())

    here = projected(pose, readout_s)
    columns = [
        (projected(_moved(pose, step), readout_s) - projected(_moved(pose, -step), readout_s)) / (2.0 * size)
        for step, size in zip(np.diag(STEP), STEP, strict=True)
    ]
    by_readout = (projected(pose, readout_s + STEP_S) - projected(pose, readout_s - STEP_S)) / (2.0 * STEP_S)
    ahead = camera.px_from_camera(points @ rotation_from_vector(pose[:3]).T + pose[3:] + 1e-3 * motion[0, 3:])
    still = camera.px_from_camera(points @ rotation_from_vector(pose[:3]).T + pose[3:])
    jacobian = np.array(columns).T
    pose_step = np.linalg.pinv(jacobian)
    return _Image(
        pose_step=pose_step,
        by_readout=by_readout,
        observable=by_readout - jacobian @ (pose_step @ by_readout),
        residual=one.view.image_points_px.ravel() - here,
        flow_px_s=np.asarray((ahead - still).mean(axis=0) / 1e-3),
    )


def _moved(pose: Array, step: Array) -> Array:
    """Return a pose (rotation vector, translation) after a left-multiplied rotation and a translation."""
    turned = rotation_from_vector(step[:3]) @ rotation_from_vector(pose[:3])
    return np.concatenate([vector_from_rotation(turned), pose[3:] + step[3:]])


def _estimate(images: Sequence[_Image], readout_s: float) -> ReadoutEstimate:
    """Return the estimate with the larger of two standard deviations: noise per point, and per image."""
    information = sum(float(one.observable @ one.observable) for one in images)
    scores = np.array([float(one.observable @ one.residual) for one in images])
    squares = sum(float(one.residual @ one.residual) for one in images)
    left = sum(one.residual.size for one in images) - 6 * len(images) - 1
    by_points = squares / max(left, 1) / max(information, 1e-12)
    by_images = float((scores**2).sum()) * len(images) / (len(images) - 1) / max(information, 1e-12) ** 2
    sd_ms = 1000.0 * max(by_points, by_images) ** 0.5
    return ReadoutEstimate(
        readout_ms=1000.0 * readout_s,
        sd_ms=float(np.sqrt(sd_ms**2 + FLOOR_MS**2 + (FLOOR_RATIO * 1000.0 * readout_s) ** 2)),
        images=len(images),
        speed_px_s=float(np.median([np.hypot(*one.flow_px_s) for one in images])),
        rms_px=float(np.sqrt(squares / max(left, 1))),
    )


def _ways(images: Sequence[_Image]) -> tuple[list[_Image], list[_Image]]:
    """Return the images with positive and those with negative motion along the main direction."""
    flows = np.array([one.flow_px_s for one in images])
    along = flows @ np.linalg.svd(flows)[2][0]
    quick = np.abs(along) > 0.25 * np.abs(along).max()
    forth = [
        one for one, speed, is_quick in zip(images, along, quick, strict=True) if is_quick and speed > 0.0
    ]
    back = [
        one for one, speed, is_quick in zip(images, along, quick, strict=True) if is_quick and speed < 0.0
    ]
    return forth, back


def _reject_motion(images: Sequence[_Image], estimate: ReadoutEstimate) -> None:
    found, context = _found(estimate), _context(estimate)
    if estimate.speed_px_s < MIN_SPEED_PX_S:
        raise CalibrationError(
            "READOUT_TOO_SLOW",
            f"the board moved at {estimate.speed_px_s:.0f} px/s, needed {MIN_SPEED_PX_S:.0f} px/s ({found})",
            MOVE,
            {**context, "min_speed_px_s": MIN_SPEED_PX_S},
        )
    forth, back = _ways(images)
    if min(len(forth), len(back)) < MIN_WAYS:
        raise CalibrationError(
            "READOUT_ONE_WAY",
            f"the board moved one way in {len(forth)} images and back in {len(back)}, "
            f"needed {MIN_WAYS} of each",
            MOVE,
            {**context, "forth": len(forth), "back": len(back), "needed": MIN_WAYS},
        )


def _reject_uncertain(estimate: ReadoutEstimate) -> None:
    if estimate.sd_ms <= MAX_SD_MS:
        return
    raise CalibrationError(
        "READOUT_UNOBSERVABLE",
        f"this motion does not determine the readout time: {_found(estimate)}, allowed {MAX_SD_MS:.1f} ms",
        "Hold the board nearer, so that it fills half of the picture, and facing the camera. " + MOVE,
        {**_context(estimate), "max_sd_ms": MAX_SD_MS},
    )


def _found(estimate: ReadoutEstimate) -> str:
    return f"readout {estimate.readout_ms:.1f} ms, standard deviation {estimate.sd_ms:.1f} ms"


def _context(estimate: ReadoutEstimate) -> dict[str, object]:
    return {
        "speed_px_s": round(estimate.speed_px_s),
        "sd_ms": round(estimate.sd_ms, 2),
        "images": estimate.images,
        "readout_estimate": _found(estimate),
    }


def _reject_impossible(estimate: ReadoutEstimate, period_s: float) -> None:
    reach_ms = 3.0 * estimate.sd_ms
    if -reach_ms <= estimate.readout_ms <= 1000.0 * period_s + reach_ms:
        return
    raise CalibrationError(
        "READOUT_IMPOSSIBLE",
        f"{_found(estimate)}: it must be between 0 and the {1000.0 * period_s:.1f} ms between images",
        "Switch off rotation and mirroring of the image. If that does not help, the times of the images are "
        "wrong: try another port.",
        {**_context(estimate), "readout_ms": round(estimate.readout_ms, 2), "period_ms": 1000.0 * period_s},
    )


def _rms(residual: Array) -> float:
    return float(np.sqrt(2.0 * np.mean(residual**2)))
