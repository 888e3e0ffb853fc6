"""After a loss the drill disappears from picture, JSON and 3-D with that image, and an alarm is raised."""

import asyncio
from collections.abc import Iterator
from dataclasses import dataclass

import pytest

from server.config import RehearsalEventConfig
from tests.server.loop.published_theatre import BEGIN_S, GONE, ShownTheatre
from tracker.navigation import AbsentReason
from tracker.navigation.alarms import Condition
from tracker.navigation.motion_monitor import SCENE_PERIOD_S
from tracker.rehearsal import Renderer

AT_S = BEGIN_S + 0.5
LONGEST_S = 1.6
# The fixed scene is checked periodically, and twice before the camera counts as moved.
SCENE_S = 3.0 * SCENE_PERIOD_S
# A marker that jumps is unseen in that image, and found in the next.
SEARCH_S = 0.04


@dataclass(frozen=True, slots=True, kw_only=True)
class Loss:
    """A loss with its expected consequences and times.

    Attributes:
        event: of the rehearsal.
        size_mm: size of the movement.
        reason: for missing numbers.
        alarm: that is raised.
        gone_after_s: how long after the event the axis may still be shown; with 0 that very image lacks it.
        alarm_after_s: how long after that the alarm may be raised.
        reference: whether the patient has a marker.

    """

    event: str
    reason: AbsentReason
    alarm: Condition
    gone_after_s: float = 0.0
    alarm_after_s: float = 0.0
    size_mm: float = 12.0
    reference: bool = True


LOSSES = {
    "marker": Loss(
        event="drill_occluded",
        reason=AbsentReason.MARKER_UNSEEN,
        alarm=Condition.DRILL_UNSEEN,
        alarm_after_s=0.25,
    ),
    "reference": Loss(
        event="reference_occluded",
        reason=AbsentReason.REFERENCE_UNSEEN,
        alarm=Condition.REFERENCE_UNSEEN,
        alarm_after_s=0.25,
    ),
    "pose-jumped": Loss(
        event="drill_jumps", size_mm=45.0, reason=AbsentReason.POSE_JUMPED, alarm=Condition.POSE_JUMPED
    ),
    "camera-moved": Loss(
        event="camera_moves",
        reason=AbsentReason.CAMERA_MOVED,
        alarm=Condition.CAMERA_MOVED,
        gone_after_s=SCENE_S,
        reference=False,
    ),
}


class Theatres:
    """Makes theatres that share their static background, by whether they have a reference."""

    def __init__(self, patch: pytest.MonkeyPatch, rendered: dict[bool, Renderer]) -> None:
        self._patch, self._rendered = patch, rendered
        self._made: list[ShownTheatre] = []

    def make(self, event: str, *, size_mm: float = 12.0, reference: bool = True) -> ShownTheatre:
        events = [RehearsalEventConfig.model_validate({"kind": event, "at_s": AT_S, "size_mm": size_mm})]
        after = self._rendered.get(reference)
        made = ShownTheatre(events, self._patch, reference=reference, after=after)
        self._rendered[reference] = made.renderer
        self._made.append(made)
        return made

    def close(self) -> None:
        for one in self._made:
            one.close()


@pytest.fixture(scope="module")
def rendered() -> dict[bool, Renderer]:
    return {}


@pytest.fixture
def theatres(monkeypatch: pytest.MonkeyPatch, rendered: dict[bool, Renderer]) -> Iterator[Theatres]:
    made = Theatres(monkeypatch, rendered)
    yield made
    made.close()


def in_order(theatre: ShownTheatre) -> None:
    """Before the event the drill is in picture, JSON and scene, without alarms."""
    while theatre.now_s < AT_S - 1e-9:
        shown = theatre.image()
        assert (shown.is_drawn, shown.is_in_message, shown.is_on_stage) == (True, True, True)
        assert shown.alarms == {}


@pytest.mark.parametrize("name", LOSSES)
def test_what_is_lost_is_gone_everywhere_with_its_image(theatres: Theatres, name: str) -> None:
    loss = LOSSES[name]

    async def play() -> None:
        theatre = theatres.make(loss.event, size_mm=loss.size_mm, reference=loss.reference)
        in_order(theatre)
        shown = theatre.image()
        assert loss.gone_after_s > 0.0 or not shown.is_in_message
        while loss.reason is not shown.reason:
            # All outputs or none, in every image.
            assert shown.is_in_message == shown.is_hinted_at == shown.is_drawn == shown.is_on_stage
            assert shown.at_s < AT_S + loss.gone_after_s + SEARCH_S, "it is shown still"
            shown = theatre.image()
        gone_at_s = shown.at_s
        while loss.alarm.value not in shown.alarms:
            assert shown.at_s <= gone_at_s + loss.alarm_after_s, "no alarm came"
            assert not shown.is_hinted_at
            shown = theatre.image()
        assert not shown.is_hinted_at
        assert set(shown.alarms) == {loss.alarm.value}

    asyncio.run(play())


def test_a_camera_that_is_gone_takes_everything_with_it_at_once(theatres: Theatres) -> None:
    async def play() -> None:
        theatre = theatres.make("camera_stops")
        in_order(theatre)
        shown = theatre.no_image(GONE)
        assert not shown.is_hinted_at
        assert shown.message.snapshot is None
        assert set(shown.alarms) == {"CAMERA_GONE"}

    asyncio.run(play())


def test_a_camera_that_stalls_is_announced_and_leaves_no_picture(theatres: Theatres) -> None:
    async def play() -> None:
        theatre = theatres.make("camera_stalls")
        in_order(theatre)
        last_s = theatre.now_s
        shown = theatre.no_image()
        while "CAMERA_STALLED" not in shown.alarms:
            assert shown.at_s - last_s < LONGEST_S
            shown = theatre.no_image()
        # Each display judges the age of a picture; after the alarm there is none.
        assert shown.at_s - last_s == pytest.approx(0.5, abs=0.1)
        assert not shown.is_hinted_at
        assert shown.message.snapshot is None

    asyncio.run(play())
