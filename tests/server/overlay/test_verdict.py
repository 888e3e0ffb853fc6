"""The verdict has a word, a shape and a colour of its own, and green only where it is sure."""

from collections.abc import Callable

import numpy as np
import pytest

from server.overlay import draw_overlay, panel_of
from server.overlay.ink import Image
from server.overlay.verdict import COLOURS, GREEN, draw_verdict
from server.overlay.words import VERDICT_WORDS, VerdictSaid
from tracker.navigation import NavigationSnapshot, Verdict

SnapshotOf = Callable[..., NavigationSnapshot]
ON_THE_AXIS = {"tip_in_vertebra_mm": (0.0, 0.0, 12.0), "tilt_rad": 0.0}
SIZES = [(1280, 720), (1920, 1080), (3840, 2160), (720, 1280)]


def grey(size_wh_px: tuple[int, int] = (1280, 720)) -> Image:
    return np.full((size_wh_px[1], size_wh_px[0], 3), 110, np.uint8)


def is_green(image: Image) -> bool:
    return bool((np.abs(image.astype(int) - np.array(GREEN)).max(axis=2) < 30).any())


@pytest.mark.parametrize(
    ("theatre", "verdict", "detail"),
    [
        pytest.param(ON_THE_AXIS, Verdict.ON, "", id="on"),
        pytest.param({}, Verdict.OFF, "ahead: inferior, class C", id="off"),
        pytest.param(
            {"tip_in_vertebra_mm": (117.0, 0.0, -20.0), "tilt_rad": 0.0},
            Verdict.OFF,
            "misses the pedicle",
            id="beside-the-patient",
        ),
        pytest.param({"tilt_rad": 0.3}, Verdict.THROUGH, "superior wall, 0.3 mm", id="through"),
        pytest.param(
            {"tip_in_vertebra_mm": (0.0, 0.0, 42.3), "tilt_rad": 0.0},
            Verdict.THROUGH,
            "2.3 mm past the end",
            id="past-the-end",
        ),
        pytest.param({**ON_THE_AXIS, "pose_variance": 1.0}, Verdict.UNSURE, "±3.1 of 2.0 mm", id="unsure"),
    ],
)
def test_each_verdict_is_said_with_its_reason(
    snapshot_of: SnapshotOf, theatre: dict[str, object], verdict: Verdict, detail: str
) -> None:
    said = panel_of(snapshot_of(**theatre)).verdict
    assert said == VerdictSaid(verdict=verdict, word=VERDICT_WORDS[verdict], detail=detail)


def test_green_is_only_for_a_drill_that_is_surely_on_its_way(snapshot_of: SnapshotOf) -> None:
    size = (1280, 720)
    assert is_green(draw_overlay(grey(), snapshot_of(size_wh_px=size, **ON_THE_AXIS)))
    for theatre in ({**ON_THE_AXIS, "pose_variance": 1.0}, {}, {"tilt_rad": 0.3}, {"seen": False}):
        assert not is_green(draw_overlay(grey(), snapshot_of(size_wh_px=size, **theatre)))


def test_without_numbers_nothing_is_said_of_the_drill(snapshot_of: SnapshotOf) -> None:
    assert panel_of(snapshot_of(seen=False)).verdict is None


def _drawn(verdict: Verdict) -> Image:
    image = grey((300, 120))
    said = VerdictSaid(verdict=verdict, word="SAME")
    draw_verdict(image, said, left_px=10, bottom_px=100, width_px=240, scale=1.0)
    return image


def test_without_colour_the_shapes_still_differ() -> None:
    inked = [_drawn(verdict)[48:100, 10:58].min(axis=2) > 60 for verdict in Verdict]
    for index, shape in enumerate(inked):
        for other in inked[index + 1 :]:
            assert (shape != other).mean() > 0.03


def test_two_verdicts_that_share_a_colour_are_both_warnings() -> None:
    assert {verdict for verdict, colour in COLOURS.items() if colour == GREEN} == {Verdict.ON}


@pytest.mark.parametrize("size", SIZES)
def test_all_of_it_has_its_place_in_the_picture(snapshot_of: SnapshotOf, size: tuple[int, int]) -> None:
    worst = snapshot_of(size_wh_px=size, tip_in_vertebra_mm=(20.0, 0.0, -99.0), tilt_rad=1.5)
    scale = min(size[1] / 720.0, size[0] / 880.0)
    drawn = draw_overlay(grey(size), worst)
    # Nothing of the stack on the left reaches the small print above it, nor the lower border.
    height = size[1]
    changed = (drawn != 110).any(axis=2)[:, round(20 * scale) : round(60 * scale)].any(axis=1)
    rows = np.flatnonzero(changed)
    small_print, stack = rows[rows < 42 * scale], rows[rows >= 42 * scale]
    assert len(small_print) > 0
    assert stack[0] > 45 * scale
    assert stack[-1] < height - 15 * scale
