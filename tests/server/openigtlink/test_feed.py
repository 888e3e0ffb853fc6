"""What a client receives, and when it is informed that its data is stale, by the page's limits."""

from math import inf

import pytest

from server import openigtlink_wire as wire
from server.config import LimitsConfig
from server.openigtlink.feed import Feed
from server.openigtlink_wire import Message
from tests.server.conftest import make_snapshot
from tests.server.openigtlink.spoken import contents, said

UNIX_S = 1_764_000_000.0
FIGURES_S, REASONS_S = 0.15, 0.5
LIVE = {("TRANSFORM", "drillToCamera"), ("TRANSFORM", "drillToVertebra"), ("POINT", "drillTip")}
TEXTS = {("STRING", "Headline"), ("STATUS", "Coaxial"), ("POINT", "Plan")}


def feed() -> Feed:
    return Feed(LimitsConfig())


def sent(to: Feed, *, captured_at_s: float = 100.0, after_s: float = 0.03, **given: object) -> list[Message]:
    snapshot = make_snapshot(judged=True, captured_at_s=captured_at_s, **given)  # pyrefly: ignore[bad-argument-type]
    return to.messages(contents(snapshot), now_s=captured_at_s + after_s, unix_offset_s=UNIX_S)


def expired(to: Feed, at_s: float) -> list[Message]:
    return to.expired(now_s=at_s, unix_offset_s=UNIX_S)


def answers_to(to: Feed, kind: str, at_s: float = 100.0, device: str = "any") -> list[Message]:
    request = Message(type=kind, device=device, timestamp_s=0.0)
    return to.answer(request, now_s=at_s, unix_offset_s=UNIX_S)


def test_an_image_is_sent_with_the_time_of_its_capture() -> None:
    messages = sent(feed())
    assert set(said(messages)) == LIVE | TEXTS
    times = {one.timestamp_s for one in messages if (one.type, one.device) in LIVE}
    assert times == {UNIX_S + 100.0}


def test_plan_and_state_are_sent_when_they_change() -> None:
    one = feed()
    sent(one)
    assert set(said(sent(one, captured_at_s=100.1))) == LIVE | {("STRING", "Headline")}
    after = said(sent(one, captured_at_s=100.2, planned=False))
    assert after["STATUS", "Plan"] == "NO_PLAN"


@pytest.mark.parametrize(
    ("after_s", "is_live"), [(0.0, True), (FIGURES_S, True), (FIGURES_S + 1e-6, False), (0.4, False)]
)
def test_a_late_image_has_no_figures(after_s: float, *, is_live: bool) -> None:
    messages = said(sent(feed(), captured_at_s=100.0 if after_s else 0.0, after_s=after_s))
    assert (set(messages) >= LIVE) is is_live
    if not is_live:
        assert {messages["STATUS", device] for _, device in LIVE} == {"TOO_OLD"}
        assert str(messages["STRING", "Headline"]).startswith("TOO_OLD")


@pytest.mark.parametrize(("after_s", "reason"), [(0.4, "MARKER_UNSEEN"), (0.6, "TOO_OLD")])
def test_a_reason_lasts_as_long_as_its_picture(after_s: float, reason: str) -> None:
    messages = said(sent(feed(), after_s=after_s, seen=False))
    assert {messages["STATUS", device] for _, device in LIVE} == {reason}


def test_when_images_stop_the_client_is_informed_once_at_the_limit() -> None:
    one = feed()
    assert one.expires_at_s == inf
    sent(one)
    assert one.expires_at_s == 100.0 + FIGURES_S
    assert expired(one, one.expires_at_s) == []
    received = said(expired(one, one.expires_at_s + 1e-6))
    assert set(received) == {("STATUS", device) for _, device in LIVE} | {("STRING", "Headline")}
    assert one.expires_at_s == 100.0 + REASONS_S
    assert said(expired(one, 101.0)) == {("STATUS", "Coaxial"): "TOO_OLD"}
    assert one.expires_at_s == inf
    assert expired(one, 200.0) == []
    # The next image restores everything.
    assert set(said(sent(one, captured_at_s=200.0))) == LIVE | {("STRING", "Headline"), ("STATUS", "Coaxial")}


def test_what_is_unseen_or_gone_takes_the_pose_away_at_once() -> None:
    one = feed()
    sent(one)
    unseen = said(sent(one, captured_at_s=100.03, seen=False))
    assert {unseen["STATUS", device] for _, device in LIVE} == {"MARKER_UNSEEN"}
    sent(one, captured_at_s=100.06)
    gone = said(sent(one, captured_at_s=100.09, with_tool=False))
    assert {gone["STATUS", device] for _, device in LIVE} == {"GONE"}


def test_an_instant_without_an_image_takes_all_away() -> None:
    one = feed()
    sent(one)
    empty = contents(None)
    received = said(one.messages(empty, now_s=100.05, unix_offset_s=UNIX_S))
    assert {received["STATUS", device] for _, device in LIVE} == {"GONE"}
    assert received["STRING", "Headline"] == "NO IMAGE"
    assert (received["STATUS", "Plan"], received["STATUS", "Coaxial"]) == ("NO_IMAGE", "NO_IMAGE")
    assert one.expires_at_s == inf
    assert one.messages(empty, now_s=100.1, unix_offset_s=UNIX_S) == []


def test_a_client_asks_for_the_state_and_never_gets_an_old_one() -> None:
    one = feed()
    assert said(answers_to(one, "GET_STATUS")) == {("STATUS", "any"): "NO_IMAGE"}
    sent(one)
    assert said(answers_to(one, "GET_STATUS", 100.4)) == {("STATUS", "any"): "OK"}
    assert said(answers_to(one, "GET_STATUS", 100.6, device="")) == {("STATUS", "Coaxial"): "TOO_OLD"}


def test_a_client_asks_what_is_spoken() -> None:
    (answer,) = answers_to(feed(), "GET_CAPABIL")
    assert answer.type == "CAPABILITY"
    assert len(answer.content) % 12 == 0
    assert b"TRANSFORM" in answer.content


@pytest.mark.parametrize("ending", ["TRANSFOR", "TRANS"])
def test_a_client_stops_its_poses_and_starts_them_again(ending: str) -> None:
    one = feed()
    sent(one)
    received = said(answers_to(one, f"STP_{ending}"))
    assert {received["STATUS", device] for _, device in LIVE} == {"STOPPED"}
    assert received[f"RTS_{ending}", "any"] == b"\0"
    assert one.expires_at_s == inf
    assert sent(one, captured_at_s=100.1) == []
    assert set(said(answers_to(one, f"STT_{ending}"))) == {(f"RTS_{ending}", "any")}
    assert set(said(sent(one, captured_at_s=100.2))) == LIVE | TEXTS


@pytest.mark.parametrize("kind", ["TRANSFORM", "IMAGE", "GET_IMAGE", "STT_TDATA", "RTS_STATUS", ""])
def test_what_is_not_known_is_ignored(kind: str) -> None:
    assert answers_to(feed(), kind) == []


def test_all_messages_can_be_packed() -> None:
    one = feed()
    for messages in (sent(one), expired(one, 101.0), answers_to(one, "GET_CAPABIL")):
        for version in wire.VERSIONS:
            assert all(wire.pack(message, version=version) for message in messages)
