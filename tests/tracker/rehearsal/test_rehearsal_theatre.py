"""The theatre's geometry: moving and static parts, and their consistency."""

import numpy as np
import pytest

from tracker.errors import InvalidInput
from tracker.geometry import angle_between_deg
from tracker.navigation import deviation_from_channel
from tracker.rehearsal import Phase, Theatre, TheatreSettings

SEEDS = (1, 7)
TIMES_S = np.arange(0.0, 40.0, 0.1)


@pytest.mark.parametrize("seed", SEEDS)
def test_tool_and_marker_agree(seed: int) -> None:
    theatre = Theatre(TheatreSettings(seed=seed))
    for at_s in (0.0, 9.1, 33.3, 1234.5):
        truth = theatre.truth_at(at_s)
        expected = truth.camera_from_marker @ theatre.tool.marker_from_tool
        np.testing.assert_array_equal(truth.camera_from_tool.matrix, expected.matrix)
        half = theatre.marker.side_mm / 2.0
        top_left = truth.camera_from_marker.move_points([-half, half, 0.0])
        np.testing.assert_allclose(truth.corners_px[0], theatre.camera.px_from_camera(top_left)[0])


@pytest.mark.parametrize("seed", SEEDS)
def test_the_hand_stays_near_the_channel_but_never_on_it(seed: int) -> None:
    theatre = Theatre(TheatreSettings(seed=seed))
    vertebra_from_camera = theatre.camera_from_vertebra.inverse
    steady, drifting, depths = [], [], []
    for at_s in TIMES_S:
        truth = theatre.truth_at(at_s)
        deviation = deviation_from_channel(vertebra_from_camera @ truth.camera_from_tool, theatre.channels[0])
        if truth.phase in (Phase.ALIGN, Phase.DRILL):
            steady.append((deviation.tip_offset_mm, deviation.angle_deg))
            depths.append(deviation.depth_mm)
        if truth.phase is Phase.DRIFT:
            drifting.append((deviation.tip_offset_mm, deviation.angle_deg))
    offsets, angles = np.array(steady).T
    assert 0.3 < np.median(offsets) < 1.2
    assert offsets.max() < 1.7
    assert 0.5 < np.median(angles) < 2.5
    assert angles.max() < 3.2
    assert offsets.min() > 0.0
    assert max(depths) > 20.0
    assert (np.max(drifting, axis=0) > (3.0, 5.0)).all()


@pytest.mark.parametrize("seed", SEEDS)
def test_the_marker_is_away_for_two_seconds_and_in_view_while_it_matters(seed: int) -> None:
    theatre = Theatre(TheatreSettings(seed=seed))
    truths = [theatre.truth_at(at_s) for at_s in TIMES_S]
    width, _ = theatre.camera.size_wh_px
    outside = [
        bool((truth.corners_px[:, 0] > width).all() or (truth.corners_px[:, 1] < 0).all()) for truth in truths
    ]
    assert sum(outside) * 0.1 >= 2.0
    assert not any(truth.marker_in_view for truth, out in zip(truths, outside, strict=True) if out)
    working = (Phase.ALIGN, Phase.DRILL, Phase.DRIFT)
    assert all(truth.marker_in_view for truth in truths if truth.phase in working)
    approach = [truth.marker_in_view for truth in truths if truth.phase is Phase.APPROACH]
    assert np.mean(approach) > 0.9


@pytest.mark.parametrize("seed", SEEDS)
def test_the_marker_is_seen_obliquely_but_readable(seed: int) -> None:
    theatre = Theatre(TheatreSettings(seed=seed))
    for at_s in TIMES_S:
        truth = theatre.truth_at(at_s)
        if truth.marker_in_view:
            pose = truth.camera_from_marker
            assert 10.0 < angle_between_deg(pose.rotation[:, 2], -pose.translation_mm) < 50.0
            assert np.linalg.norm(np.diff(truth.corners_px, axis=0), axis=1).min() > 45.0


def test_the_hand_is_smooth_and_trembles() -> None:
    theatre = Theatre(TheatreSettings(seed=3))
    times = np.arange(13.0, 17.0, 1.0 / 200.0)
    tips = np.array([theatre.truth_at(at_s).camera_from_tool.translation_mm for at_s in times])
    assert np.linalg.norm(np.diff(tips, axis=0), axis=1).max() < 0.15
    wave = tips[:, 0] - np.polyval(np.polyfit(times, tips[:, 0], 3), times)
    power = np.abs(np.fft.rfft(wave * np.hanning(len(wave)))) ** 2
    rates = np.fft.rfftfreq(len(wave), 1.0 / 200.0)
    fast = rates > 4.0
    assert 8.0 <= rates[fast][np.argmax(power[fast])] <= 11.0


def test_the_motion_repeats_after_its_cycle_and_does_not_jump_there() -> None:
    theatre = Theatre(TheatreSettings(seed=5))
    for at_s in (0.0, 7.7, 39.99):
        early, late = theatre.truth_at(at_s), theatre.truth_at(at_s + 3 * theatre.cycle_s)
        np.testing.assert_allclose(early.corners_px, late.corners_px, atol=1e-6)
    before, after = theatre.truth_at(40.0 - 1e-4), theatre.truth_at(40.0 + 1e-4)
    np.testing.assert_allclose(before.corners_px, after.corners_px, atol=0.1)


def test_another_seed_is_another_camera_and_another_hand() -> None:
    one, two = (Theatre(TheatreSettings(seed=seed)) for seed in (1, 2))
    assert np.abs(one.camera.distortion - two.camera.distortion).max() > 1e-3
    assert np.abs(one.truth_at(9.0).corners_px - two.truth_at(9.0).corners_px).max() > 2.0


def test_the_lens_bends_lines_visibly() -> None:
    camera = Theatre(TheatreSettings()).camera
    assert -0.2 <= camera.distortion[0] <= -0.1
    corner = camera.normalised_from_px([[0.0, 0.0]])[0]
    straight = camera.matrix[:2, :2] @ corner + camera.matrix[:2, 2]
    assert np.linalg.norm(straight) > 10.0


@pytest.mark.parametrize(
    ("key", "value"),
    [
        pytest.param("noise", -0.1, id="noise-below-none"),
        pytest.param("blur", 11.0, id="blur-beyond-hardest"),
        pytest.param("clutter", float("nan"), id="clutter-not-a-number"),
        pytest.param("light", float("inf"), id="light-endless"),
        pytest.param("seed", -1, id="seed-negative"),
        pytest.param("size_wh_px", (1280, 10), id="image-too-flat"),
    ],
)
def test_a_setting_out_of_range_is_rejected_by_name(key: str, value: object) -> None:
    with pytest.raises(InvalidInput) as caught:
        TheatreSettings(**{key: value})  # pyrefly: ignore[bad-argument-type]  # wrong on purpose
    assert caught.value.code == "REHEARSAL_SETTING_INVALID"
    assert key in caught.value.message
