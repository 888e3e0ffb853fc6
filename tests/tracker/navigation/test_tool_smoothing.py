"""Which tools are smoothed, and that all values derive from the displayed pose."""

import numpy as np
import pytest

from tests.server.conftest import make_snapshot
from tracker.navigation import (
    Absent,
    Deviation,
    NavigationSnapshot,
    ToolPose,
    ToolSmoothing,
    deviation_from_channel,
    navigate,
)
from tracker.navigation.tool_smoothing import channel_wall_distance_mm
from tracker.plan import Channel
from tracker.pose import SmoothingSettings, marker_point_covariance_mm2

CHANNEL = Channel(
    name="L3 left",
    entry_in_vertebra_mm=np.zeros(3),
    target_in_vertebra_mm=np.array([0.0, 0.0, 40.0]),
    radius_mm=4.0,
)
FAR = (0.0, 0.0, -30.0)
PERIOD_S = 1.0 / 30.0


def navigated(
    settings: SmoothingSettings,
    tips_mm: list[tuple[float, float, float] | None],
) -> list[NavigationSnapshot]:
    """Snapshots of a tool with its tip at these points of the vertebra, unseen where None."""
    steadying = ToolSmoothing(settings)
    snapshots = []
    for k, tip in enumerate(tips_mm):
        raw = make_snapshot(tip_in_vertebra_mm=tip or FAR, seen=tip is not None, captured_at_s=k * PERIOD_S)
        snapshots.append(
            navigate(
                setup=raw.setup,
                sightings=raw.sightings,
                image_number=k,
                captured_at_s=raw.captured_at_s,
                size_wh_px=raw.size_wh_px,
                stage_ms=raw.stage_ms,
                skipped_images=0,
                steadied=steadying.steadied(raw.setup, raw.sightings, captured_at_s=raw.captured_at_s),
            )
        )
    return snapshots


def lags_ms(snapshots: list[NavigationSnapshot]) -> list[float]:
    tools = [snapshot.tools["drill"] for snapshot in snapshots]
    return [round(tool.lag_ms, 6) for tool in tools if isinstance(tool, ToolPose)]


def trembling(base: tuple[float, float, float]) -> list[tuple[float, float, float] | None]:
    return [(base[0] + 0.005 * (-1) ** k, base[1], base[2]) for k in range(4)]


def test_without_a_lag_the_numbers_are_the_same_to_the_last_bit() -> None:
    tips = trembling(FAR)
    for snapshot, tip in zip(navigated(SmoothingSettings(), tips), tips, strict=True):
        assert tip is not None
        plain = make_snapshot(tip_in_vertebra_mm=tip)
        assert snapshot.deviations == plain.deviations
        now, before = snapshot.tools["drill"], plain.tools["drill"]
        assert isinstance(now, ToolPose)
        assert isinstance(before, ToolPose)
        assert np.array_equal(now.camera_from_tool.matrix, before.camera_from_tool.matrix)
        assert np.array_equal(now.tip_covariance_mm2, before.tip_covariance_mm2)
        assert now.lag_ms == 0.0


def test_away_from_the_wall_a_tool_is_smoothed_and_states_its_lag() -> None:
    snapshots = navigated(SmoothingSettings(lag_ms=50.0), trembling(FAR))
    assert lags_ms(snapshots) == pytest.approx([0.0, 1000 / 60, 1000 / 30, 50.0])
    last = snapshots[-1].deviations["drill"]
    alone = make_snapshot(tip_in_vertebra_mm=FAR).deviations["drill"]
    assert isinstance(last, Deviation)
    assert isinstance(alone, Deviation)
    # The tremor of 0.005 mm is removed.
    assert last.tip_offset_mm == pytest.approx(alone.tip_offset_mm, abs=1e-4)


def test_the_numbers_are_those_of_the_pose_that_is_drawn() -> None:
    snapshot = navigated(SmoothingSettings(lag_ms=50.0), trembling(FAR))[-1]
    tool, setup = snapshot.tools["drill"], snapshot.setup
    assert isinstance(tool, ToolPose)
    assert isinstance(setup.channel, Channel)
    assert not isinstance(snapshot.vertebra, Absent)
    assert snapshot.deviations["drill"] == deviation_from_channel(
        snapshot.vertebra.camera_from_vertebra.inverse @ tool.camera_from_tool, setup.channel
    )


@pytest.mark.parametrize(
    ("tip_mm", "near_wall", "steadied"),
    [
        pytest.param((0.5, 0.0, 20.0), False, False, id="in-the-channel"),
        pytest.param((0.5, 0.0, 20.0), True, True, id="in-the-channel-and-asked-for"),
        pytest.param((0.0, 0.0, -4.9), False, False, id="the-rim-just-near"),
        pytest.param((0.0, 0.0, -5.2), False, True, id="the-rim-just-not-near"),
    ],
)
def test_near_the_wall_the_image_itself_is_shown_unless_asked(
    tip_mm: tuple[float, float, float], near_wall: bool, steadied: bool
) -> None:
    settings = SmoothingSettings(lag_ms=50.0, near_wall=near_wall, near_wall_mm=3.0)
    assert (lags_ms(navigated(settings, trembling(tip_mm)))[-1] > 0.0) is steadied


def test_an_unseen_tool_is_not_extrapolated_and_restarts() -> None:
    snapshots = navigated(SmoothingSettings(lag_ms=50.0), [FAR, FAR, FAR, None, FAR])
    assert isinstance(snapshots[3].tools["drill"], Absent)
    assert lags_ms(snapshots)[-1] == 0.0


def test_the_tip_is_no_surer_than_in_its_images() -> None:
    snapshot = navigated(SmoothingSettings(lag_ms=50.0), [FAR] * 4)[-1]
    tool, sighting = snapshot.tools["drill"], make_snapshot(tip_in_vertebra_mm=FAR).sightings["drill"]
    assert isinstance(tool, ToolPose)
    own = marker_point_covariance_mm2(sighting.camera_from_marker, sighting.pose_covariance, [0, -70, 0])  # pyrefly: ignore[missing-attribute]  # it is seen
    assert np.trace(tool.tip_covariance_mm2) >= np.trace(own) * (1 - 1e-9)


@pytest.mark.parametrize(
    ("offset_mm", "depth_mm", "gap_mm"),
    [
        pytest.param(0.0, 20.0, 4.0, id="on-the-axis"),
        pytest.param(3.0, 20.0, 1.0, id="inside-near-the-side"),
        pytest.param(1.0, 39.0, 1.0, id="inside-near-the-end"),
        pytest.param(0.0, -10.0, 10.0, id="before-the-entry"),
        pytest.param(7.0, -4.0, 5.0, id="before-and-beside-the-rim"),
        pytest.param(6.0, 20.0, 2.0, id="beside"),
        pytest.param(4.0, 20.0, 0.0, id="on-the-wall"),
    ],
)
def test_the_gap_is_the_distance_from_the_surface_of_the_channel(
    offset_mm: float, depth_mm: float, gap_mm: float
) -> None:
    deviation = Deviation(
        entry_offset_mm=0.0,
        angle_deg=0.0,
        depth_mm=depth_mm,
        remaining_mm=40.0 - depth_mm,
        tip_offset_mm=offset_mm,
        entry_lateral_mm=0.0,
        entry_cranial_mm=0.0,
        transverse_deg=0.0,
        sagittal_deg=0.0,
        angle_medial_deg=0.0,
        angle_cranial_deg=0.0,
    )
    assert channel_wall_distance_mm(deviation, CHANNEL) == pytest.approx(gap_mm)
