"""The vertebra: closed, of realistic size, with channels that stay inside their pedicles."""

import numpy as np
import pytest

from tracker.geometry import Array
from tracker.plan import Channel
from tracker.rehearsal.anatomy import (
    bone_field,
    bone_normals,
    canal_field,
    landmark_needles,
    pedicle_channels,
    vertebra_surface,
)
from tracker.rehearsal.marker_images import drill_marker_image
from tracker.rehearsal.meshing import surface_net

# The entry is on a slope of the bone: the cylinder's rim is inside from here on.
RIM_MM = 1.5


def mantle(channel: Channel, radius_mm: float, from_mm: float) -> Array:
    """Points on the channel's cylinder, from this depth to its end."""
    axis = channel.axis_in_vertebra
    across = np.cross(axis, [0.0, 0.0, 1.0])
    across /= np.linalg.norm(across)
    up = np.cross(axis, across)
    depth = np.linspace(from_mm, channel.length_mm, 90)[:, None, None]
    angle = np.linspace(0.0, 2.0 * np.pi, 72)[None, :, None]
    ring = radius_mm * (np.cos(angle) * across + np.sin(angle) * up)
    return np.asarray(channel.entry_in_vertebra_mm + depth * axis + ring, dtype=np.float64)


@pytest.mark.parametrize("channel", pedicle_channels(), ids=lambda channel: channel.name)
def test_the_whole_channel_lies_in_bone_and_leaves_the_canal_alone(channel: Channel) -> None:
    for radius_mm in (0.0, 0.5 * channel.radius_mm, channel.radius_mm):
        points = mantle(channel, radius_mm, RIM_MM)
        assert bone_field(points).max() < -0.2
        assert canal_field(points).min() > 0.5


@pytest.mark.parametrize("channel", pedicle_channels(), ids=lambda channel: channel.name)
def test_the_channel_starts_on_the_surface_and_fills_most_of_its_pedicle(channel: Channel) -> None:
    assert abs(float(bone_field(channel.entry_in_vertebra_mm))) < 0.05
    # With 1.5 mm more it would break through the narrowest part.
    assert bone_field(mantle(channel, channel.radius_mm + 1.5, 5.0)).max() > 0.0


def test_left_is_left_in_lps_and_right_mirrors_it() -> None:
    left, right = pedicle_channels()
    assert "left" in left.name
    assert left.entry_in_vertebra_mm[0] > 10.0
    np.testing.assert_allclose(left.entry_in_vertebra_mm * [-1, 1, 1], right.entry_in_vertebra_mm, atol=1e-6)


def test_the_surface_is_closed_and_wound_outwards() -> None:
    surface = vertebra_surface()
    directed = np.concatenate([surface.faces[:, [0, 1]], surface.faces[:, [1, 2]], surface.faces[:, [2, 0]]])
    # Each edge is used once in each direction: closed, with consistent orientation.
    key = directed[:, 0] * len(surface.vertices_mm) + directed[:, 1]
    back = directed[:, 1] * len(surface.vertices_mm) + directed[:, 0]
    assert len(np.unique(key)) == len(key)
    np.testing.assert_array_equal(np.sort(key), np.sort(back))
    # One hole: the canal.
    assert len(surface.vertices_mm) - len(key) // 2 + len(surface.faces) == 0
    a, b, c = (surface.vertices_mm[surface.faces[:, i]] for i in range(3))
    outward = np.einsum("ij,ij->i", np.cross(b - a, c - a), bone_normals((a + b + c) / 3.0))
    assert (outward > 0.0).mean() > 0.995


def test_the_vertebra_has_the_size_of_an_l3() -> None:
    surface = vertebra_surface()
    assert 8_000 <= len(surface.faces) <= 20_000
    assert 60.0 < surface.volume_ml < 110.0
    width, depth, height = np.ptp(surface.vertices_mm, axis=0)
    assert 85.0 < width < 98.0
    assert 80.0 < depth < 100.0
    assert 45.0 < height < 65.0
    assert np.abs(bone_field(surface.vertices_mm)).max() < 0.02


def test_the_pedicles_are_about_nine_millimetres_wide() -> None:
    across = np.arange(5.0, 35.0, 0.02)
    widths = []
    for y in np.arange(-6.0, 4.0, 1.0):
        line = np.stack([across, np.full_like(across, y), np.full_like(across, 4.5)], axis=1)
        widths.append(float((bone_field(line) < 0.0).sum()) * 0.02)
    assert 8.0 < min(widths) < 10.5


def test_the_needles_stick_in_the_bone_with_their_heads_outside() -> None:
    needles = landmark_needles()
    assert len(needles) == 3
    for needle in needles:
        assert bone_field(needle.tip_in_vertebra_mm) < -1.0
        assert bone_field(needle.head_in_vertebra_mm) > 10.0
    # One in a superior articular process, two on the spinous process in the midline.
    assert abs(needles[0].tip_in_vertebra_mm[0]) > 15.0
    assert all(abs(needle.tip_in_vertebra_mm[0]) < 2.0 for needle in needles[1:])


def test_a_ball_is_netted_as_a_ball() -> None:
    axis = np.arange(-8.0, 8.5, 0.5)
    x, y, z = np.meshgrid(axis, axis, axis, indexing="ij")
    values = (np.sqrt(x**2 + y**2 + z**2) - 6.0).astype(np.float32)
    vertices, faces = surface_net(values, origin_mm=(-8.0, -8.0, -8.0), step_mm=0.5)
    np.testing.assert_allclose(np.linalg.norm(vertices, axis=1), 6.0, atol=0.06)
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6.0
    assert volume == pytest.approx(4.0 / 3.0 * np.pi * 216.0, rel=0.01)


def test_no_rotation_or_reflection_maps_the_marker_to_itself() -> None:
    emblem = drill_marker_image(100).astype(np.float64)
    others = [np.rot90(face, turns) for face in (emblem, emblem[:, ::-1]) for turns in range(4)][1:]
    for other in others:
        assert np.abs(emblem - other).mean() > 12.0


def test_the_marker_is_black_along_its_edge_and_has_contrast_when_small() -> None:
    emblem = drill_marker_image()
    assert emblem.shape == (400, 400)
    rim = np.concatenate(
        [emblem[:60].ravel(), emblem[-60:].ravel(), emblem[:, :60].ravel(), emblem[:, -60:].ravel()]
    )
    assert rim.max() == 0
    small = drill_marker_image(30)
    assert small.max() == 255
    assert 0.15 < (small > 127).mean() < 0.45
