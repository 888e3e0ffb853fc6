"""The card for missing video shows the first reason, and is made once for all viewers."""

from collections.abc import Callable
from datetime import datetime

import pytest

from server.live import Instant, Problem, ProcessState, ProcessStatus, SourceState, SourceStatus
from server.stream.no_video import NoVideoCard, reasons_for_no_video
from tracker.navigation import NavigationSnapshot

InstantOf = Callable[..., Instant]
GONE = Problem(code="CAMERA_GONE", message="camera 0 gives no image", remedy="Plug it in.")
DIED = Problem(code="DIED", message="tracking died 5 times in a minute", remedy="Restart the server.")
NOON = datetime(2026, 1, 1, 12, 0, 0).astimezone()


@pytest.mark.parametrize(
    ("process", "source", "reasons"),
    [
        pytest.param(
            ProcessStatus(state=ProcessState.GIVEN_UP, problem=DIED),
            SourceStatus(name="0", state=SourceState.RECONNECTING, problem=GONE),
            ("Tracking died 5 times in a minute.", "Restart the server."),
            id="the-process-first",
        ),
        pytest.param(
            ProcessStatus(state=ProcessState.RUNNING),
            SourceStatus(name="0", state=SourceState.RECONNECTING, problem=GONE),
            ("Camera 0 gives no image.", "Plug it in."),
            id="then-the-source",
        ),
        pytest.param(
            ProcessStatus(state=ProcessState.RESTARTING),
            SourceStatus(name="0", state=SourceState.RUNNING),
            ("Tracking has stopped and is being restarted.",),
            id="a-state-without-a-problem",
        ),
        pytest.param(
            ProcessStatus(state=ProcessState.RUNNING),
            SourceStatus(name="0", state=SourceState.RUNNING),
            ("Waiting for the first image.",),
            id="all-runs-but-no-image",
        ),
    ],
)
def test_the_reason_is_reported(
    instant_of: InstantOf, process: ProcessStatus, source: SourceStatus, reasons: tuple[str, ...]
) -> None:
    assert reasons_for_no_video(instant_of(1, process=process, source=source), now_s=5.0) == reasons


def test_a_frozen_image_is_reported_with_its_age(
    instant_of: InstantOf, snapshot_of: Callable[..., NavigationSnapshot]
) -> None:
    instant = instant_of(1, snapshot=snapshot_of(captured_at_s=5.0))
    assert reasons_for_no_video(instant, now_s=8.4) == ("No new image for 3 s.",)


def test_before_anything_tracking_is_starting() -> None:
    assert reasons_for_no_video(None, now_s=0.0) == ("Tracking is starting.",)


def test_the_card_is_made_again_only_when_it_has_to_say_something_else(instant_of: InstantOf) -> None:
    card = NoVideoCard()
    first = card.jpeg(instant_of(1), now_s=0.0, clock=NOON)
    assert card.jpeg(instant_of(2), now_s=0.3, clock=NOON) is first
    assert card.jpeg(instant_of(3), now_s=1.0, clock=NOON.replace(second=1)) is not first
