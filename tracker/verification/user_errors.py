"""Simulated human errors: tool calibration, CT marking, needle clicks and ruler readings."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from tracker.geometry import Array, Rigid, rotation_from_vector
from tracker.pose import ToolModel
from tracker.registration.needles import NeedleObservation, RulerMeasurement, needle_from_clicks
from tracker.rehearsal import Needle, Theatre
from tracker.rehearsal.anatomy import bone_field
from tracker.rehearsal.landmarks import surface_exits
from tracker.verification.settings import VerificationSettings

ENTRY_VISIBLE_MM = 1.0
MAX_OCCLUDED_MM = 30.0
SIGHT_STEPS_MM = np.arange(0.3, 80.0, 0.4)


def calibrated_tool(
    tool: ToolModel, settings: VerificationSettings, random: np.random.Generator
) -> ToolModel:
    """Return the tool with calibration errors and the covariance that the calibration states."""
    true = tool.marker_from_tool
    lean = np.append(random.normal(0.0, np.radians(settings.axis_sd_deg), 2), 0.0)
    return replace(
        tool,
        marker_from_tool=Rigid(
            rotation=true.rotation @ rotation_from_vector(lean),
            translation_mm=true.translation_mm + random.normal(0.0, settings.tip_sd_mm, 3),
        ),
        tip_covariance_mm2=settings.tip_sd_mm**2 * np.eye(3),
        axis_sd_deg=settings.axis_sd_deg,
    )


def mark_on_ct(points_mm: Array, sd_mm: float, random: np.random.Generator) -> Array:
    """Return points (n, 3) with the random error of marking them on the CT."""
    return np.asarray(points_mm + random.normal(0.0, sd_mm, np.shape(points_mm)))


def measure_by_ruler(theatre: Theatre, middle_mm: Array, random: np.random.Generator) -> RulerMeasurement:
    """Return V, H and azimuth to the needles' centre (3,) with errors; the patient is not exactly level."""
    stated_sd = RulerMeasurement(vertical_mm=1.0, horizontal_mm=1.0)
    lying = rotation_from_vector(random.normal(0.0, np.radians(stated_sd.prone_sd_deg), 3))
    to_camera = lying @ (theatre.camera_from_vertebra.inverse.translation_mm - middle_mm)
    beside = float(np.hypot(to_camera[0], to_camera[2]))
    azimuth = float(np.degrees(np.arctan2(to_camera[0], -to_camera[2])))
    return RulerMeasurement(
        vertical_mm=float(to_camera[1]) + random.normal(0.0, stated_sd.ruler_sd_mm),
        horizontal_mm=beside + random.normal(0.0, stated_sd.ruler_sd_mm),
        azimuth_deg=azimuth + random.normal(0.0, stated_sd.azimuth_sd_deg),
    )


def mark_needle(
    theatre: Theatre, needle: Needle, settings: VerificationSettings, random: np.random.Generator
) -> NeedleObservation:
    """Return a needle as a user marks it in the image: from its visible entry to its head."""
    entry = needle_entries((needle,))[0]
    to_head_mm = needle.head_in_vertebra_mm - entry
    length_mm = float(np.linalg.norm(to_head_mm))
    hidden_mm = occluded_by_bone_mm(theatre, entry, to_head_mm / length_mm)
    ends = np.stack([entry + hidden_mm / length_mm * to_head_mm, needle.head_in_vertebra_mm])
    px = theatre.camera.px_from_camera(theatre.camera_from_vertebra.move_points(ends))
    px = px + random.normal(0.0, settings.click_sd_px, (2, 2))
    return needle_from_clicks(
        px[0], px[1], sd_px=settings.click_sd_px, entry_is_seen=hidden_mm < ENTRY_VISIBLE_MM
    )


def needle_entries(needles: Sequence[Needle]) -> Array:
    """Return the points (n, 3) at which needles exit the bone."""
    tips = np.stack([needle.tip_in_vertebra_mm for needle in needles])
    directions = np.stack([needle.head_in_vertebra_mm for needle in needles]) - tips
    return surface_exits(tips, directions / np.linalg.norm(directions, axis=1, keepdims=True))


def occluded_by_bone_mm(theatre: Theatre, entry_mm: Array, direction: Array) -> float:
    """Return the length of needle, from its entry, that bone occludes in the camera's view."""
    along_mm = np.arange(0.0, MAX_OCCLUDED_MM, 0.1)
    points = entry_mm + along_mm[:, None] * direction
    sights = theatre.camera_from_vertebra.inverse.translation_mm - points
    sights /= np.linalg.norm(sights, axis=1, keepdims=True)
    # The first steps along the line of sight are left out: the bone at the needle's own entry does not
    # occlude it.
    before = points[:, None] + SIGHT_STEPS_MM[None, :, None] * sights[:, None]
    behind = (bone_field(before) < 0.0).any(axis=1)
    return float(along_mm[behind].max(initial=0.0))
