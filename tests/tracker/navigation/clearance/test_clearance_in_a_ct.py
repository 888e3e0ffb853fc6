"""Clearance and its probability on the surface from a CT, against the implicit solid that was scanned."""

from functools import cache

import numpy as np
import pytest
from scipy.special import ndtr

from tests.tracker.navigation.bones import drill_at
from tests.tracker.plan.bone.phantoms import SCANS as EVERY
from tests.tracker.plan.bone.phantoms import WAIST_MM, Scan
from tracker.geometry import Array, Rigid, Tool, Vertebra
from tracker.navigation.clearance import (
    NearestWall,
    WallDistanceField,
    bone_distance_field,
    clearance_of_drill,
    drill_rings,
)
from tracker.navigation.uncertainty import UncertainPose, probability_of_breach
from tracker.plan import Channel
from tracker.plan.bone import bone_surface

# How far the surface of each scan is from the bone is tested with the surface.
SCANS = {name: EVERY[name] for name in ("usual-cortex", "thin-cortex-in-coarse-voxels")}
RADIUS_MM = 2.0
# Along the phantom's pedicle, as far as into the body.
AXIS = np.array([-np.tan(np.radians(14.0)), -1.0, np.tan(np.radians(-6.0))])
CHANNEL = Channel(
    name="L3 left",
    entry_in_vertebra_mm=WAIST_MM - 18.0 * AXIS,
    target_in_vertebra_mm=WAIST_MM + 16.0 * AXIS,
    radius_mm=2.5,
)
DEPTH_MM = 24.0


@cache
def wall_of(name: str) -> tuple[WallDistanceField, float]:
    made = bone_surface(SCANS[name].volume)
    return bone_distance_field(made.surface, CHANNEL, margin_mm=15.0), made.sd_mm


def true_clearance_mm(scanned: Scan, pose: Rigid[Vertebra, Tool]) -> float:
    """The smallest depth of the cylinder below the true wall in the pedicle."""
    along, turn = np.meshgrid(np.linspace(-12.0, 0.0, 121), np.linspace(0.0, 2.0 * np.pi, 181))
    local = np.stack([RADIUS_MM * np.cos(turn), RADIUS_MM * np.sin(turn), along], axis=-1).reshape(-1, 3)
    return float(-scanned.signed_mm(pose.move_points(local))[0].max())


def wall_points_mm(scanned: Scan) -> Array:
    """Points on the true wall at the isthmus, medial and lateral."""
    pedicle = scanned.phantom.pedicles["left"]
    along, turn = np.meshgrid(np.linspace(-4.0, 4.0, 17), np.linspace(-0.6, 0.6, 13))
    growth = 1.0 + pedicle.widening_per_mm2 * along**2
    up = np.cross(pedicle.axis, pedicle.across)
    sides = []
    for way in (-1.0, 1.0):
        u = way * 0.5 * pedicle.width_mm * growth * np.cos(turn)
        v = 0.5 * pedicle.height_mm * growth * np.sin(turn)
        offset = along[..., None] * pedicle.axis + u[..., None] * pedicle.across + v[..., None] * up
        sides.append((pedicle.waist_mm + offset).reshape(-1, 3))
    return np.concatenate(sides)


@pytest.mark.parametrize("name", SCANS)
def test_the_distance_at_the_true_wall_is_zero(name: str) -> None:
    points = wall_points_mm(SCANS[name])
    assert np.abs(SCANS[name].phantom.bone_distance_mm(points)).max() < 0.01
    wall, sd_mm = wall_of(name)
    # Negative here means that the clearance is overestimated.
    off_mm, _ = wall.distances_mm(points)
    assert -0.08 < np.median(off_mm) < 0.1
    assert np.sqrt(np.mean(off_mm**2)) < sd_mm


@pytest.mark.parametrize("medial_mm", [-1.2, 1.2])
@pytest.mark.parametrize("name", SCANS)
def test_the_clearance_of_a_drill_is_that_to_the_solid_and_not_more(name: str, medial_mm: float) -> None:
    pose = drill_at(CHANNEL, DEPTH_MM, medial_mm=medial_mm)
    truth_mm = true_clearance_mm(SCANS[name], pose)
    wall, sd_mm = wall_of(name)
    rings = drill_rings(pose, CHANNEL, wall, radius_mm=RADIUS_MM, length_mm=100.0)
    now = clearance_of_drill(rings, pose, CHANNEL).now
    assert isinstance(now, NearestWall)
    assert -0.3 < now.clearance_mm - truth_mm < 0.1
    assert abs(now.clearance_mm - truth_mm) < 2.0 * sd_mm
    tool = UncertainPose(pose=pose, covariance=np.zeros((6, 6)))
    probability = probability_of_breach(rings.now, wall, tool, wall_sd_mm=sd_mm)
    assert probability.sd_mm == pytest.approx(sd_mm, rel=0.05)
    assert probability.through_ratio == pytest.approx(float(ndtr(-now.clearance_mm / sd_mm)), abs=0.02)
