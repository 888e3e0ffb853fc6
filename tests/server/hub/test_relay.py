"""Messages that the hub sends on: ages are upper bounds on its clock, and what is too old is not sent."""

import json

import pytest

from server.hub.delays import Arrival
from server.hub.relay import relayed
from server.stream.messages import LiveMessage
from tests.server.hub.test_hub_publisher import live_text

LIVE = live_text()


def arrival(*, transfer_ms: float | None = 20.0, age_ms: float | None = 50.0) -> Arrival:
    return Arrival(arrived_s=1000.0, transfer_ms=transfer_ms, age_ms=age_ms)


def test_the_age_counts_on_from_the_arrival_and_the_capture_is_on_the_hubs_clock() -> None:
    text = relayed(LIVE.encode(), arrival()).text(now_s=1000.1)
    assert text is not None
    message = LiveMessage.model_validate_json(text)
    assert message.snapshot is not None
    assert message.image_age_ms == pytest.approx(170.0)
    assert (message.sent_at_s, message.snapshot.captured_at_s) == pytest.approx((1000.1, 999.93))
    # The rest is the theatre's own.
    own = LiveMessage.model_validate_json(LIVE)
    assert (message.headline, message.alarms, message.sequence) == (own.headline, own.alarms, own.sequence)


def test_a_small_picture_states_its_scale() -> None:
    text = relayed(LIVE.encode(), arrival(), has_picture=True).text(now_s=1000.1)
    assert text is not None
    assert json.loads(text)["shown_scale_ratio"] == pytest.approx(
        320 / json.loads(text)["snapshot"]["width_px"]
    )


@pytest.mark.parametrize(
    ("transfer_ms", "now_s"),
    [
        pytest.param(None, 1000.0, id="of-unknown-age"),
        pytest.param(1001.0, 1000.0, id="it-took-too-long"),
        pytest.param(20.0, 1000.99, id="it-waited-here"),
    ],
)
def test_what_may_be_old_is_not_sent(transfer_ms: float | None, now_s: float) -> None:
    assert relayed(LIVE.encode(), arrival(transfer_ms=transfer_ms)).text(now_s=now_s) is None


@pytest.mark.parametrize("content", [b"", b"[]", b"{}", b'{"snapshot": {}}', LIVE[:500].encode()])
def test_a_message_of_another_version_is_not_sent(content: bytes) -> None:
    with pytest.raises(ValueError, match=r"."):
        relayed(content, arrival())


def test_an_image_without_its_age_is_not_sent() -> None:
    with pytest.raises(ValueError, match="without an age"):
        relayed(LIVE.encode(), arrival(age_ms=None))
