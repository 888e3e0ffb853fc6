"""The state of tracking between two images: every attribute is assigned, and nothing is shared."""

import numpy as np
import pytest

from server.capture.shot import Shot
from server.config import Config
from server.loop.ring import ImageRing
from server.loop.tracking import Tracking
from server.loop.tracking_state import (
    DERIVED,
    STATE,
    ObjectState,
    StateError,
    StateRequest,
    TrackingState,
    capture_state,
    restore_state,
    tracking_state_bytes,
    unpickled_state,
)
from server.loop.worker import LatestRequest, StateSender
from server.setup import build_setup
from tracker.pipeline import Tracker
from tracker.pipeline.idle_search import IdleSearch
from tracker.pipeline.second_prints import SecondPrints


@pytest.fixture
def tracking() -> Tracking:
    made = Tracking(build_setup(Config.model_validate({"camera": {"source": "0"}})))
    made.process(shot(0), skipped_images=0)
    return made


def shot(number: int) -> Shot:
    image = np.full((48, 64, 3), number, np.uint8)
    return Shot(image=image, number=number, captured_at_s=1.0 + number / 30, source_time_s=0.0)


def test_every_attribute_is_either_state_or_derived(tracking: Tracking) -> None:
    tracker = tracking._tracker
    assert isinstance(tracker, Tracker)
    parts: list[object] = [
        tracking,
        tracker,
        tracker._idle_search,
        tracker._second_prints,
        tracker.focal_length,
    ]
    found = {type(one): one for one in [*parts, tracking._steadying]}
    assert found.keys() == STATE.keys() == DERIVED.keys() >= {IdleSearch, SecondPrints}
    for kind, one in found.items():
        assert set(vars(one)) == STATE[kind] | DERIVED[kind], kind
        assert not STATE[kind] & DERIVED[kind]


def test_a_restored_tracking_goes_on_alone(tracking: Tracking) -> None:
    state = unpickled_state(tracking_state_bytes(tracking))
    assert state is not None
    other = restore_state(state, at_s=2.0)
    assert other._tracker is not None
    assert tracking._tracker is not None
    before = other._tracker._idle_search._image_number
    tracking.process(shot(1), skipped_images=0)
    assert other._tracker._idle_search._image_number == before
    assert other._watching._looked_at_s == 1.0


def test_a_state_of_another_version_is_rejected(tracking: Tracking) -> None:
    state = capture_state(tracking)
    attributes = {**state.tracking.attributes, "_of_another_version": 1}
    other = TrackingState(
        preparation=state.preparation,
        size_wh_px=state.size_wh_px,
        tracking=ObjectState(name="Tracking", attributes=attributes),
    )
    with pytest.raises(StateError, match="_of_another_version"):
        restore_state(other, at_s=2.0)


def test_the_state_is_stored_when_it_is_requested_and_after_each_change_of_the_case(
    tracking: Tracking,
) -> None:
    ring, requests = ImageRing(image_bytes=64 * 48 * 3), LatestRequest()
    sender = StateSender(ring, requests, is_recording=False)
    sender.note_changed_case()
    assert sender.store(tracking) == 0
    requests.put(StateRequest(is_recording=True))
    first = sender.store(tracking)
    assert first > 0
    assert sender.store(tracking) == 0
    sender.note_changed_case()
    second = sender.store(tracking)
    assert second > first
    assert ring.state(first) is None
    assert ring.state(second) is not None
    requests.put(StateRequest(is_recording=False))
    sender.note_changed_case()
    assert sender.store(tracking) == 0


def test_a_process_that_starts_while_a_recording_runs_sends_its_state_with_the_first_image(
    tracking: Tracking,
) -> None:
    sender = StateSender(ImageRing(image_bytes=64 * 48 * 3), LatestRequest(), is_recording=True)
    assert sender.store(tracking) > 0


def test_a_state_that_cannot_be_captured_or_is_too_large_stops_nothing(
    tracking: Tracking, monkeypatch: pytest.MonkeyPatch
) -> None:
    small = ImageRing(image_bytes=64 * 48 * 3, state_bytes=100)
    assert StateSender(small, LatestRequest(), is_recording=True).store(tracking) == -1
    monkeypatch.setattr("server.loop.tracking_state.capture_state", lambda _: int("no"))
    ring = ImageRing(image_bytes=64 * 48 * 3)
    assert StateSender(ring, LatestRequest(), is_recording=True).store(tracking) == -1
