"""The filter setting reaches the navigation results, which report its lag."""

import dataclasses
from collections.abc import Callable

import numpy as np

from server.capture.shot import Shot
from server.config import Config, RehearsalConfig, SmoothingConfig
from server.live import Instant
from server.loop.tracking import Tracking
from server.overlay import draw_overlay, panel_of
from server.setup import build_setup
from server.stream.messages import live_message
from server.stream.pose_messages import ToolMessage
from server.theatre import theatre_from_config
from tracker.navigation import NavigationSnapshot, ToolPose

REHEARSAL = RehearsalConfig(width=640, height=360)


def concluded(image: np.ndarray, smoothing: SmoothingConfig) -> ToolPose:
    """The drill of the rehearsal in the fourth of four equal images, 30 a second."""
    preparation = build_setup(Config(rehearsal=REHEARSAL, smoothing=smoothing))
    tracking = Tracking(preparation)
    for k in range(4):
        shot = Shot(image=image, number=k, captured_at_s=k / 30, source_time_s=k / 30)
        tool = tracking.process(shot, skipped_images=0).tools["drill"]
    assert isinstance(tool, ToolPose)
    return tool


def test_poses_are_steadied_where_it_is_set_and_by_default_not_at_all() -> None:
    image = theatre_from_config(REHEARSAL).renderer().image_at(0.0)
    assert concluded(image, SmoothingConfig()).lag_ms == 0.0
    assert round(concluded(image, SmoothingConfig(lag_ms=50, near_wall=True)).lag_ms, 3) == 50.0


def test_the_lag_is_in_the_message_in_the_panel_and_in_the_picture(
    snapshot_of: Callable[..., NavigationSnapshot], instant_of: Callable[..., Instant]
) -> None:
    plain = snapshot_of()
    tool = plain.tools["drill"]
    assert isinstance(tool, ToolPose)
    late = dataclasses.replace(plain, tools={"drill": dataclasses.replace(tool, lag_ms=49.6)})
    for snapshot, note, lag_ms in ((plain, "", 0.0), (late, "smoothed · 50 ms delay", 49.6)):
        message = live_message(instant_of(1, snapshot=snapshot), now_s=1.0)
        assert message.snapshot is not None
        pose = message.snapshot.tools[0].pose
        assert isinstance(pose, ToolMessage)
        assert pose.lag_ms == lag_ms
        assert panel_of(snapshot).note == note
    grey = np.full((360, 640, 3), 110, np.uint8)
    assert not np.array_equal(draw_overlay(grey, plain), draw_overlay(grey, late))
