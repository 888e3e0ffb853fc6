"""Simulated needles seen by a camera whose position was measured with a ruler."""

from dataclasses import dataclass

import numpy as np

from tracker.camera import CameraModel
from tracker.geometry import Array, Camera, Rigid, Vertebra, rotation_from_vector, vector_from_rotation
from tracker.plan import Landmark
from tracker.registration.needles import (
    NeedleFit,
    NeedleLimits,
    NeedleObservation,
    PlannedNeedle,
    RulerMeasurement,
    TouchedPoint,
    ViewPrior,
    needle_from_clicks,
    planned_at_landmarks,
    register_needles,
    view_prior_from_ruler,
)
from tracker.registration.needles.observation import OCCLUDED_MM, OCCLUDED_SD_MM

CAMERA = CameraModel(
    matrix=np.array([[1400.0, 0, 640.0], [0, 1400.0, 360.0], [0, 0, 1]]),
    distortion=np.array([-0.16, 0.04, 1e-4, -2e-4, 0.0]),
    size_wh_px=(1280, 720),
)
# One needle in the right superior articular process, two on the spinous process.
ENTRIES = np.array([[-20.1, 18.6, 18.8], [-0.6, 48.5, 0.3], [-0.4, 51.5, -17.0]])
NAMES = ("right superior articular process", "spinous process above", "spinous process below")
PLACING_MM, CLICK_PX, TOUCH_MM = 0.7, 1.0, 0.5
# The standard deviations that the measured view states.
STATED = RulerMeasurement(vertical_mm=1.0, horizontal_mm=1.0)


@dataclass(frozen=True, kw_only=True)
class Seen:
    """One simulated registration: input and truth."""

    places: tuple[PlannedNeedle, ...]
    seen: tuple[NeedleObservation, ...]
    view: ViewPrior
    camera_from_vertebra: Rigid[Camera, Vertebra]


def scene(seed: int, *, entry_is_seen: bool = True, touched: int = 0, entries: Array = ENTRIES) -> Seen:
    """Everything is drawn with the stated standard deviations."""
    random = np.random.default_rng([seed, 0x4E444C])
    elevation, azimuth = np.radians([random.uniform(30.0, 65.0), random.uniform(-35.0, 35.0)])
    distance_mm = random.uniform(450.0, 900.0)
    to_camera = np.array(
        [
            np.cos(elevation) * np.sin(azimuth),
            np.sin(elevation),
            -np.cos(elevation) * np.cos(azimuth),
        ]
    )
    # The ruler assumes a flat patient; the vertebra is rotated from there.
    lying = rotation_from_vector(random.normal(0.0, np.radians(STATED.prone_sd_deg), 3))
    right = np.cross(-to_camera, [0.0, 1.0, 0.0])
    right /= np.linalg.norm(right)
    level = rotation_from_vector(-to_camera * random.normal(0.0, np.radians(STATED.roll_sd_deg)))
    flat = np.stack([right, np.cross(-to_camera, right), -to_camera]) @ level
    middle = np.array([*random.uniform(-40.0, 40.0, 2), distance_mm])
    # A camera not centred on the needles is rotated, so that the ruler's line of sight stays true.
    sight = middle / np.linalg.norm(middle)
    off_axis = _turn(np.array([0.0, 0.0, 1.0]), sight)
    rotation = off_axis @ flat @ lying
    landmarks = entries + random.normal(0.0, PLACING_MM, entries.shape)
    pose: Rigid[Camera, Vertebra] = Rigid(
        rotation=rotation, translation_mm=distance_mm * sight - rotation @ landmarks.mean(axis=0)
    )
    ruler = random.normal(0.0, STATED.ruler_sd_mm, 2)
    measured = RulerMeasurement(
        vertical_mm=distance_mm * np.sin(elevation) + ruler[0],
        horizontal_mm=distance_mm * np.cos(elevation) + ruler[1],
        azimuth_deg=float(np.degrees(azimuth) + random.normal(0.0, STATED.azimuth_sd_deg)),
    )
    seen = []
    for entry in entries:
        lean = np.array([0.0, 1.0, 0.0]) + np.radians(15.0) * random.normal(size=3) * [1.0, 0.0, 1.0]
        lean /= np.linalg.norm(lean)
        # Bone hides some of it, as is stated: a gamma curve has that mean and spread.
        ratio = OCCLUDED_SD_MM**2 / OCCLUDED_MM
        hidden = 0.0 if entry_is_seen else min(float(random.gamma(OCCLUDED_MM / ratio, ratio)), 25.0)
        ends = np.stack([entry + hidden * lean, entry + 38.0 * lean])
        px = CAMERA.px_from_camera(pose.move_points(ends)) + random.normal(0.0, CLICK_PX, (2, 2))
        seen.append(needle_from_clicks(px[0], px[1], sd_px=CLICK_PX, entry_is_seen=entry_is_seen))
    points = [Landmark(name=str(name), point_lps_mm=at) for name, at in zip(NAMES, landmarks, strict=True)]
    tips = tuple(
        TouchedPoint(
            name=point.name,
            point_lps_mm=point.point_lps_mm,
            point_in_camera_mm=pose.move_points(entry) + random.normal(0.0, TOUCH_MM, 3),
            covariance_mm2=TOUCH_MM**2 * np.eye(3),
        )
        for point, entry in zip(points[:touched], entries, strict=False)
    )
    at_px = np.mean([one.entry_px for one in seen], axis=0)
    return Seen(
        places=planned_at_landmarks(points, placing_sd_mm=PLACING_MM),
        seen=tuple(seen),
        view=view_prior_from_ruler(measured, CAMERA, at_px, touched=tips),
        camera_from_vertebra=pose,
    )


def _turn(one: Array, other: Array) -> Array:
    axis = np.cross(one, other)
    sine = float(np.linalg.norm(axis))
    return rotation_from_vector(axis / max(sine, 1e-12) * np.arctan2(sine, float(one @ other)))


# No limit rejects a fit: the covariance itself is tested.
OPEN = NeedleLimits(
    min_probability_ratio=1e-12, max_offset_mm=1e3, min_delta_chi2=0.0, max_swap_delta_chi2=1e3
)


def registered(given: Seen, limits: NeedleLimits | None = None) -> NeedleFit:
    return register_needles(given.places, given.seen, CAMERA, given.view, limits=limits)


def misfit(fit: NeedleFit, given: Seen) -> float:
    """Squared Mahalanobis distance of the truth from the fit: 6 on average if calibrated."""
    pose, truth = fit.registration.anchor_from_vertebra, given.camera_from_vertebra
    off = np.concatenate(
        [
            pose.translation_mm - truth.translation_mm,
            vector_from_rotation(pose.rotation @ truth.rotation.T),
        ]
    )
    return float(off @ np.linalg.solve(fit.registration.covariance, off))
