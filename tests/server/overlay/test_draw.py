"""Overlays are drawn at their true positions, and absent values are not drawn."""

import dataclasses
from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from server.overlay import OverlayContent, draw_overlay, encode_jpeg
from server.overlay.primitives import DRILL_ORANGE, PLAN_BLUE
from tracker.errors import InvalidInput
from tracker.geometry import Camera, Rigid, Vertebra, cylinder_ring_mm
from tracker.navigation import Absent, NavigationSnapshot, PlacedScrew, ToolPose, VertebraPose
from tracker.plan import Channel
from tracker.pose import Seen

SnapshotOf = Callable[..., NavigationSnapshot]
Picture = npt.NDArray[np.uint8]
GOLDEN = Path(__file__).parent / "golden"
# The panel's area in a picture of 640x360, with numbers and with text.
PANELS_PX = (np.s_[20:, :132], np.s_[285:, :310])


def grey(size_wh_px: tuple[int, int] = (640, 360)) -> Picture:
    return np.full((size_wh_px[1], size_wh_px[0], 3), 110, np.uint8)


def inked(picture: Picture, colour: tuple[int, int, int]) -> npt.NDArray[np.bool_]:
    """Pixels of this colour outside the panel, whose text is orange too."""
    near = np.abs(picture.astype(np.int16) - np.array(colour)).max(axis=2) < 60
    for panel in PANELS_PX:
        near[panel] = False
    return np.asarray(near, dtype=np.bool_)


def inked_near(ink: npt.NDArray[np.bool_], px: npt.NDArray[np.float64]) -> npt.NDArray[np.bool_]:
    """For each pixel (n, 2): is this colour within 1.5 px of it?"""
    grown = cv2.dilate(ink.astype(np.uint8), np.ones((3, 3), np.uint8)) > 0
    at = np.round(px).astype(int)
    return np.asarray(grown[at[:, 1], at[:, 0]], dtype=np.bool_)


def inside_video(px: npt.NDArray[np.float64], picture: Picture) -> npt.NDArray[np.float64]:
    height, width = picture.shape[:2]
    stored = (px > 20).all(axis=1) & (px[:, 0] < width - 5) & (px[:, 1] < height - 5)
    return np.asarray(px[stored], dtype=np.float64)


def test_the_image_handed_in_is_not_written(snapshot_of: SnapshotOf) -> None:
    image = grey()
    image.setflags(write=False)
    drawn = draw_overlay(image, snapshot_of())
    assert (image == 110).all()
    assert not np.shares_memory(drawn, image)


def test_a_grey_image_is_drawn_upon_in_colour(snapshot_of: SnapshotOf) -> None:
    drawn = draw_overlay(np.full((360, 640), 110, np.uint8), snapshot_of())
    assert np.array_equal(drawn, draw_overlay(grey(), snapshot_of()))


def test_the_drill_is_drawn_where_it_is(snapshot_of: SnapshotOf) -> None:
    snapshot = snapshot_of()
    tool = snapshot.tools["drill"]
    assert isinstance(tool, ToolPose)
    drawn = draw_overlay(grey(), snapshot)
    behind_tip_mm = np.linspace(6.0, 48.0, 40)[:, None] * [0.0, 0.0, -1.0]
    px = snapshot.setup.camera.px_from_camera(tool.camera_from_tool.move_points(behind_tip_mm))
    px = inside_video(px, drawn)
    assert len(px) > 15
    assert inked_near(inked(drawn, DRILL_ORANGE), px).all()


def test_the_channel_is_drawn_where_it_is_planned(snapshot_of: SnapshotOf) -> None:
    snapshot = snapshot_of(seen=False)
    assert not isinstance(snapshot.vertebra, Absent)
    place = snapshot.vertebra.camera_from_vertebra
    drawn = draw_overlay(grey(), snapshot)
    turn = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    for depth_mm in (0.0, 40.0):
        ring = np.stack([4 * np.cos(turn), 4 * np.sin(turn), np.full(40, depth_mm)], axis=1)
        px = snapshot.setup.camera.px_from_camera(place.move_points(ring))
        assert inked_near(inked(drawn, PLAN_BLUE), px).all()


@pytest.mark.parametrize(
    ("theatre", "drill", "plan"),
    [
        pytest.param({}, True, True, id="all-known"),
        pytest.param({"seen": False}, False, True, id="unseen-drill"),
        pytest.param({"registered": False}, True, False, id="not-registered"),
        pytest.param({"planned": False}, True, False, id="no-plan"),
        pytest.param({"with_tool": False}, False, True, id="no-tool"),
        pytest.param({"calibrated": False}, False, False, id="camera-not-calibrated"),
    ],
)
def test_only_what_is_known_is_drawn(
    snapshot_of: SnapshotOf, theatre: dict[str, bool], drill: bool, plan: bool
) -> None:
    drawn = draw_overlay(grey(), snapshot_of(**theatre))
    assert inked(drawn, DRILL_ORANGE).any() == drill
    assert inked(drawn, PLAN_BLUE).any() == plan


def test_a_placed_screw_is_drawn_where_it_was_placed(snapshot_of: SnapshotOf) -> None:
    snapshot = snapshot_of()
    channel, vertebra = snapshot.setup.channel, snapshot.vertebra
    assert isinstance(channel, Channel)
    assert isinstance(vertebra, VertebraPose)
    head = channel.entry_in_vertebra_mm + np.array([14.0, 0.0, 0.0])
    tip = head + 30.0 * channel.axis_in_vertebra
    screw = PlacedScrew(name="L3", head_in_vertebra_mm=head, tip_in_vertebra_mm=tip, radius_mm=3.0)
    setup = dataclasses.replace(snapshot.setup, placed_screws=(screw,))
    drawn = draw_overlay(grey(), dataclasses.replace(snapshot, setup=setup))
    ring = cylinder_ring_mm(
        vertebra.camera_from_vertebra.move_points(head),
        vertebra.camera_from_vertebra.rotate_directions(channel.axis_in_vertebra),
        3.0,
    )
    px = inside_video(snapshot.setup.camera.px_from_camera(ring), drawn)
    assert len(px) > 10
    changed = np.abs(drawn.astype(int) - draw_overlay(grey(), snapshot)).max(axis=2) > 30
    assert inked_near(np.asarray(changed, dtype=np.bool_), px).mean() > 0.9


def test_geometry_alone_has_the_lines_of_the_whole_and_no_panel(snapshot_of: SnapshotOf) -> None:
    geometry = draw_overlay(grey(), snapshot_of(), content=OverlayContent.GEOMETRY)
    for colour in (DRILL_ORANGE, PLAN_BLUE):
        assert inked(geometry, colour).any()
    # Without tool and channel only the marker has lines; only the panel with its reason differs.
    bare = snapshot_of(with_tool=False, planned=False, seen=False)
    assert np.array_equal(draw_overlay(grey(), bare, content=OverlayContent.GEOMETRY), grey())
    assert not np.array_equal(draw_overlay(grey(), bare), grey())


def test_a_channel_behind_the_camera_is_not_drawn(snapshot_of: SnapshotOf) -> None:
    behind = Rigid[Camera, Vertebra].from_vector([0.9, 0.35, 0.0], [5, -10, -260])
    drawn = draw_overlay(grey(), snapshot_of(camera_from_vertebra=behind, seen=False))
    assert not inked(drawn, PLAN_BLUE).any()


@settings(max_examples=60, deadline=None)
@given(
    st.tuples(*[st.floats(-3.1, 3.1)] * 3),
    st.tuples(st.floats(-1e4, 1e4), st.floats(-1e4, 1e4), st.floats(-300, 1e4)),
)
def test_no_pose_whatever_breaks_the_drawing(
    snapshot_of: SnapshotOf, turn: tuple[float, ...], place_mm: tuple[float, ...]
) -> None:
    place = Rigid[Camera, Vertebra].from_vector(list(turn), list(place_mm))
    snapshot = snapshot_of(camera_from_vertebra=place)
    assert draw_overlay(grey(), snapshot).shape == (360, 640, 3)


@pytest.mark.parametrize("wild", [np.nan, np.inf, -1e300, 1e9])
def test_wild_corners_of_a_marker_break_nothing(snapshot_of: SnapshotOf, wild: float) -> None:
    snapshot = snapshot_of()
    seen = snapshot.sightings["drill"]
    assert isinstance(seen, Seen)
    corners = seen.corners_px.copy()
    corners[2, 0] = wild
    object.__setattr__(seen, "corners_px", corners)
    assert draw_overlay(grey(), snapshot).shape == (360, 640, 3)


def test_an_image_of_another_size_is_rejected(snapshot_of: SnapshotOf) -> None:
    with pytest.raises(InvalidInput) as reported:
        draw_overlay(grey((320, 180)), snapshot_of())
    assert reported.value.code == "OVERLAY_SIZE"
    assert "320x180" in reported.value.message


@pytest.mark.parametrize(
    ("name", "theatre"),
    [
        ("navigating", {}),
        ("unseen", {"seen": False}),
        ("uncalibrated", {"calibrated": False}),
    ],
)
def test_the_picture_looks_as_it_was_approved(
    snapshot_of: SnapshotOf, name: str, theatre: dict[str, bool]
) -> None:
    """Approved by eye; to approve a change, delete the picture, run this, review and commit it."""
    drawn = draw_overlay(grey(), snapshot_of(image_number=1234, **theatre))
    path = GOLDEN / f"{name}.png"
    if not path.exists():
        cv2.imwrite(str(path), drawn)
        pytest.fail(f"there was no approved picture; a new one is at {path}")
    approved = cv2.imread(str(path))
    assert approved is not None
    off = np.abs(approved.astype(np.int16) - drawn).max(axis=2)
    # Another build of OpenCV may differ in single edge pixels, never in a line or a digit.
    assert (off > 60).mean() < 0.0005


def test_a_jpeg_shows_the_image() -> None:
    decoded = cv2.imdecode(np.frombuffer(encode_jpeg(grey(), 80), np.uint8), cv2.IMREAD_COLOR)
    assert decoded is not None
    assert np.abs(decoded.astype(int) - 110).max() <= 2


def test_an_image_without_pixels_is_rejected() -> None:
    with pytest.raises(InvalidInput) as reported:
        encode_jpeg(np.zeros((0, 0, 3), np.uint8), 80)
    assert reported.value.code == "IMAGE_NOT_ENCODED"
