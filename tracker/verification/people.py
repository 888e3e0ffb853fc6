"""What people do with their errors: calibrate the tool, mark the CT, put in needles, hold a ruler."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from tracker.geometry import Array, Rigid, rotation_from_vector
from tracker.pose import ToolModel
from tracker.registration.needles import MeasuredView, NeedleSeen, clicked_needle
from tracker.rehearsal import Needle, Theatre
from tracker.rehearsal.anatomy import bone_field
from tracker.rehearsal.landmarks import where_surface_is
from tracker.verification.settings import VerificationSettings

SEEN_TO_GO_IN_MM = 1.0
LONGEST_HIDDEN_MM = 30.0
BEFORE_MM = np.arange(0.3, 80.0, 0.4)


def calibrated_tool(
    tool: ToolModel, settings: VerificationSettings, random: np.random.Generator
) -> ToolModel:
    """The tool as a calibration knows it, which states its own spread."""
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


def marked_on_ct(points_mm: Array, sd_mm: float, random: np.random.Generator) -> Array:
    """Points (n, 3) as somebody marks them on the CT."""
    return np.asarray(points_mm + random.normal(0.0, sd_mm, np.shape(points_mm)))


def measured_by_ruler(theatre: Theatre, middle_mm: Array, random: np.random.Generator) -> MeasuredView:
    """V, H and azimuth as measured to the needles' middle (3,), on a patient who hardly lies flat."""
    stated = MeasuredView(vertical_mm=1.0, horizontal_mm=1.0)
    lying = rotation_from_vector(random.normal(0.0, np.radians(stated.lying_sd_deg), 3))
    to_camera = lying @ (theatre.camera_from_vertebra.inverse.translation_mm - middle_mm)
    beside = float(np.hypot(to_camera[0], to_camera[2]))
    azimuth = float(np.degrees(np.arctan2(to_camera[0], -to_camera[2])))
    return MeasuredView(
        vertical_mm=float(to_camera[1]) + random.normal(0.0, stated.ruler_sd_mm),
        horizontal_mm=beside + random.normal(0.0, stated.ruler_sd_mm),
        azimuth_deg=azimuth + random.normal(0.0, stated.azimuth_sd_deg),
    )


def clicked(
    theatre: Theatre, needle: Needle, settings: VerificationSettings, random: np.random.Generator
) -> NeedleSeen:
    """A needle as somebody marks it in the image: from where bone shows it to its head."""
    entry = needle_entries((needle,))[0]
    way = needle.head_in_vertebra_mm - entry
    length_mm = float(np.linalg.norm(way))
    hidden_mm = hidden_by_bone_mm(theatre, entry, way / length_mm)
    ends = np.stack([entry + hidden_mm / length_mm * way, needle.head_in_vertebra_mm])
    px = theatre.camera.px_from_camera(theatre.camera_from_vertebra.move_points(ends))
    px = px + random.normal(0.0, settings.click_sd_px, (2, 2))
    return clicked_needle(
        px[0], px[1], sd_px=settings.click_sd_px, entry_is_seen=hidden_mm < SEEN_TO_GO_IN_MM
    )


def needle_entries(needles: Sequence[Needle]) -> Array:
    """Where needles come out of the bone (n, 3)."""
    tips = np.stack([needle.tip_in_vertebra_mm for needle in needles])
    ways = np.stack([needle.head_in_vertebra_mm for needle in needles]) - tips
    return where_surface_is(tips, ways / np.linalg.norm(ways, axis=1, keepdims=True))


def hidden_by_bone_mm(theatre: Theatre, entry_mm: Array, way: Array) -> float:
    """How much of a needle, from where it goes in, lies behind bone as the camera sees it."""
    along_mm = np.arange(0.0, LONGEST_HIDDEN_MM, 0.1)
    points = entry_mm + along_mm[:, None] * way
    sights = theatre.camera_from_vertebra.inverse.translation_mm - points
    sights /= np.linalg.norm(sights, axis=1, keepdims=True)
    # Not the bone that the needle goes into itself: that is where it is seen to go in.
    before = points[:, None] + BEFORE_MM[None, :, None] * sights[:, None]
    behind = (bone_field(before) < 0.0).any(axis=1)
    return float(along_mm[behind].max(initial=0.0))
