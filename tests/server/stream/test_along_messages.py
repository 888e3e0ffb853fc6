"""The image's message has the data of the page's bull's-eye."""

from collections.abc import Callable
from functools import partial

import numpy as np
import pytest

from server.overlay import reach_of
from server.stream.along_messages import BullseyeMessage
from server.stream.snapshot_messages import snapshot_message
from tracker.geometry import Rigid
from tracker.navigation import NavigationSnapshot, bullseye_view
from tracker.navigation.clearance import NearestWall
from tracker.navigation.uncertainty import DrillAnalysis
from tracker.plan import Channel

SnapshotOf = Callable[..., NavigationSnapshot]


@pytest.fixture(scope="session")
def snapshot_of(snapshot_of: SnapshotOf) -> SnapshotOf:
    """Judged, which it is not elsewhere."""
    return partial(snapshot_of, judged=True)


def _along(snapshot: NavigationSnapshot) -> BullseyeMessage | None:
    return snapshot_message(snapshot).tools[0].along


def test_the_view_is_the_one_that_is_burned_in(snapshot_of: SnapshotOf) -> None:
    snapshot = snapshot_of()
    sent, channel, placed = _along(snapshot), snapshot.setup.channel, snapshot.vertebra_from_tool("drill")
    assert isinstance(placed, Rigid)
    judged = snapshot.analyses["drill"]
    assert sent is not None
    assert isinstance(channel, Channel)
    assert isinstance(judged, DrillAnalysis)
    seen = bullseye_view(placed, channel)
    assert sent.tip_mm == seen.tip_mm.tolist()
    assert sent.at_entry_mm == seen.at_entry_mm.tolist()
    assert sent.at_target_mm == seen.at_target_mm.tolist()
    assert sent.reach_mm == reach_of(channel)
    assert (sent.channel_radius_mm, sent.channel_length_mm) == (channel.radius_mm, channel.length_mm)
    assert sent.drill_radius_mm == snapshot.setup.tools["drill"].radius_mm
    now = judged.clearance.now
    assert isinstance(now, NearestWall)
    view = seen.view_from_vertebra @ (now.point_in_vertebra_mm - channel.entry_in_vertebra_mm)
    assert sent.nearest_mm == view.tolist()
    axes = np.array(sent.tip_half_axes_95_mm)
    across = seen.across_mm2(judged.spread.tip_covariance_mm2)
    np.testing.assert_allclose(axes.T @ axes, 5.991 * across, rtol=1e-9)


def test_a_drill_across_the_channel_has_a_tip_and_no_crossings(snapshot_of: SnapshotOf) -> None:
    sent = _along(snapshot_of(tilt_rad=1.5707963))
    assert sent is not None
    assert (sent.at_entry_mm, sent.at_target_mm) == (None, None)
    assert np.isfinite(sent.tip_mm).all()


def test_a_drill_outside_is_near_no_wall(snapshot_of: SnapshotOf) -> None:
    sent = _along(snapshot_of(tip_in_vertebra_mm=(0.0, 0.0, -8.0), tilt_rad=0.0))
    assert sent is not None
    assert sent.nearest_mm is None


@pytest.mark.parametrize("missing", [{"seen": False}, {"registered": False}])
def test_without_a_deviation_there_is_no_view(snapshot_of: SnapshotOf, missing: dict[str, bool]) -> None:
    assert _along(snapshot_of(**missing)) is None
