"""Views of a board are captured when it is still and in a new position; missing conditions are reported."""

from typing import Any

import numpy as np
import pytest

from tracker.camera.board_collector import BoardCollector, BoardCollectorProgress, ViewVerdict
from tracker.geometry import rotation_from_vector

SIZE = (1280, 720)
FOCAL = 1500.0
GRID = np.array([[x, y, 0.0] for y in range(6) for x in range(9)]) * 8.0
IDS = np.arange(len(GRID))


def seen(
    *,
    lean_deg: float = 0.0,
    rotation_deg: float = 0.0,
    at: tuple[float, float] = (0, 0),
    far_mm: float = 450.0,
) -> np.ndarray:
    """Pixels of a 9x6 board with its centre `at` mm beside the axis."""
    # A positive angle about x moves the lower edge away; leaning back is the opposite.
    turned = rotation_from_vector(np.radians([0.0, rotation_deg, 0.0])) @ rotation_from_vector(
        np.radians([-lean_deg, 0.0, 0.0])
    )
    points = (GRID - GRID.mean(axis=0)) @ turned.T + [at[0], at[1], far_mm]
    assert points[:, 2].min() > 50.0
    return np.asarray(points[:, :2] / points[:, 2:] * FOCAL + [639.5, 359.5])


def show(collector: BoardCollector, px: np.ndarray, at_s: float, drift_px: float = 0.0) -> ViewVerdict:
    """Two images of one view, a tenth of a second apart."""
    for late_s, shift in ((0.0, 0.0), (0.1, drift_px)):
        judgement = collector.offer(
            ids=IDS, object_points_mm=GRID, image_points_px=px + shift, captured_at_s=at_s + late_s
        )
    return judgement


def test_a_board_is_taken_when_it_holds_still() -> None:
    collector = BoardCollector(SIZE)
    alone = collector.offer(ids=IDS, object_points_mm=GRID, image_points_px=seen(), captured_at_s=5.0)
    assert alone is ViewVerdict.FIRST_SIGHT
    assert show(collector, seen(), 10.0, drift_px=8.0) is ViewVerdict.MOVING
    assert show(collector, seen(), 20.0) is ViewVerdict.TAKEN
    assert collector.progress.views == 1


@pytest.mark.parametrize(
    ("second", "judgement"),
    [
        pytest.param(seen(), ViewVerdict.NOTHING_NEW, id="the-same-again"),
        pytest.param(seen(lean_deg=3.0), ViewVerdict.NOTHING_NEW, id="three-degrees-more"),
        pytest.param(seen(lean_deg=25.0), ViewVerdict.TAKEN, id="tilted"),
        pytest.param(seen(at=(60.0, 0.0)), ViewVerdict.TAKEN, id="elsewhere"),
        pytest.param(seen(far_mm=650.0), ViewVerdict.TAKEN, id="farther"),
    ],
)
def test_only_what_is_new_is_taken(second: np.ndarray, judgement: ViewVerdict) -> None:
    collector = BoardCollector(SIZE)
    assert show(collector, seen(), 1.0) is ViewVerdict.TAKEN
    assert show(collector, second, 3.0) is judgement


def test_a_lost_board_has_to_be_still_again() -> None:
    collector = BoardCollector(SIZE)
    collector.offer(ids=IDS, object_points_mm=GRID, image_points_px=seen(), captured_at_s=1.0)
    collector.reset_motion()
    again = collector.offer(ids=IDS, object_points_mm=GRID, image_points_px=seen(), captured_at_s=1.1)
    assert again is ViewVerdict.FIRST_SIGHT


def test_five_points_are_too_few() -> None:
    collector = BoardCollector(SIZE)
    few = slice(0, 5)
    judgement = collector.offer(
        ids=IDS[few], object_points_mm=GRID[few], image_points_px=seen()[few], captured_at_s=1.0
    )
    assert judgement is ViewVerdict.TOO_FEW_POINTS


@pytest.mark.parametrize(
    ("view", "reached"),
    [
        pytest.param({"lean_deg": 30.0}, "upper edge away", id="leaning-back"),
        pytest.param({"lean_deg": -30.0}, "upper edge towards", id="leaning-forward"),
        pytest.param({"rotation_deg": 30.0}, "left edge away", id="turned-left-edge-back"),
        pytest.param({"rotation_deg": -30.0}, "right edge away", id="turned-right-edge-back"),
    ],
)
def test_it_states_the_missing_tilts(view: dict[str, Any], reached: str) -> None:
    collector = BoardCollector(SIZE)
    show(collector, seen(**view, far_mm=250.0), 1.0)
    tilts = [sentence for sentence in collector.progress.missing if sentence.startswith("Tilt")]
    assert len(tilts) == 3
    assert not any(reached in sentence for sentence in tilts)


def everywhere() -> BoardCollectorProgress:
    collector = BoardCollector(SIZE)
    at_s = 0.0
    for x in (-130.0, -45.0, 45.0, 130.0):
        for y, lean, turn in ((-75.0, 28.0, 0.0), (0.0, 0.0, 28.0), (75.0, -28.0, -28.0)):
            at_s += 2.0
            show(collector, seen(lean_deg=lean, rotation_deg=turn, at=(x, y)), at_s)
    return collector.progress


def test_nothing_is_missing_after_all_places_and_tilts() -> None:
    progress = everywhere()
    assert progress.missing == ()
    assert progress.views == 12
    assert progress.coverage_ratio == pytest.approx(1.0)
    assert progress.tilt_deg == pytest.approx((-28.0, 28.0, -28.0, 28.0), abs=4.0)


def test_the_corners_of_the_image_are_asked_for_first() -> None:
    collector = BoardCollector(SIZE)
    show(collector, seen(), 1.0)
    assert collector.progress.missing[0] == (
        "Hold the board into the top left, top right, bottom left, bottom right of the image."
    )
