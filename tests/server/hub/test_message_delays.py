"""The age of a message is never understated, whatever the clocks of theatre and hub show."""

import asyncio
import itertools
from math import inf, nan

import pytest
from hypothesis import given
from hypothesis import strategies as st
from nats.aio.client import Client
from nats.aio.msg import Msg

from server.clock import elapsed_s
from server.hub.connection import HubAddress
from server.hub.delays import arrival_of
from server.hub.envelope import Beats, Echo, Header, packed, unpacked
from server.hub.publisher import header_now
from server.hub.subjects import Hospital, Leaf
from server.hub.watcher import Watcher

times_s = st.floats(0.0, 30.0)
clocks_s = st.floats(0.0, 1e6)


@given(
    hub_began_s=clocks_s, theatre_began_s=clocks_s, to_theatre_s=times_s, held_s=st.floats(0.0, 9.0),
    to_hub_s=times_s, age_s=times_s, since_s=times_s,
)  # fmt: skip
def test_the_stated_age_is_at_least_the_true_one_and_exceeds_it_by_the_way_of_the_beat(
    hub_began_s: float, theatre_began_s: float, to_theatre_s: float, held_s: float,
    to_hub_s: float, age_s: float, since_s: float,
) -> None:  # fmt: skip
    # Times since the beat was sent, on two clocks that have nothing in common.
    beats = Beats()
    beats.take("hub", hub_began_s, now_s=theatre_began_s + to_theatre_s)
    sent_s = to_theatre_s + held_s
    header = Header(
        run="r", number=1, age_ms=age_s * 1000.0, echoes=beats.echoes(now_s=theatre_began_s + sent_s)
    )
    arrived_s = sent_s + to_hub_s
    arrival = arrival_of(unpacked(packed(header, b""))[0], "hub", now_s=hub_began_s + arrived_s)
    stated_ms = arrival.image_age_ms(now_s=hub_began_s + arrived_s + since_s)
    true_ms = (age_s + to_hub_s + since_s) * 1000.0
    # Clocks of a million seconds have digits of 0.1 us; a round trip of zero may come out just below it.
    if stated_ms is None:
        assert to_theatre_s + to_hub_s < 1e-6
    else:
        assert stated_ms == pytest.approx(true_ms + to_theatre_s * 1000.0, abs=1e-3)


def test_a_beat_that_the_hub_has_not_sent_measures_no_age() -> None:
    address = HubAddress(url="nats://127.0.0.1:1", hospital=Hospital("clinic"))
    watcher = Watcher(address, (Leaf.STATE,))
    opened = Watcher(address, (Leaf.STATE,), theatre="OR-1", clock_of=watcher)
    sent_s = elapsed_s()
    watcher.beats.append(sent_s)
    for beat_s, is_measured in ((sent_s, True), (sent_s + 1e-6, False)):
        header = Header(run="r", number=1, age_ms=1.0, echoes={watcher.id: Echo(beat_s=beat_s, held_s=0.0)})
        message = Msg(
            _client=Client(), subject="coaxial.clinic.theatre.OR-1.state", data=packed(header, b"{}")
        )
        for one in (watcher, opened):
            asyncio.run(one._take(message))
            received = one.newest["OR-1", Leaf.STATE]
            assert (received.arrival.transfer_ms is not None) == is_measured


def test_a_pause_while_a_header_is_made_does_not_make_the_message_younger(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    # Between any two looks at the clock the thread waits for a second.
    clock = itertools.count(100.0)
    monkeypatch.setattr("server.hub.publisher.elapsed_s", lambda: next(clock))
    monkeypatch.setattr("server.hub.publisher.time.monotonic", lambda: next(clock))
    beats = Beats()
    beats.take("hub", 100.0, now_s=100.0)
    header = header_now("r", 1, captured_at_s=99.0, beats=beats)
    sent_s = next(clock)
    age_ms = arrival_of(header, "hub", now_s=sent_s).image_age_ms(now_s=sent_s)
    assert age_ms is not None
    assert age_ms >= (sent_s - 99.0) * 1000.0


@pytest.mark.parametrize(
    ("echoes", "age_ms"),
    [
        pytest.param({}, 5.0, id="no-beat-was-returned"),
        pytest.param({"other": Echo(beat_s=99.0, held_s=0.1)}, 5.0, id="a-beat-of-another-hub"),
        pytest.param({"hub": Echo(beat_s=101.0, held_s=0.0)}, 5.0, id="a-beat-of-the-future"),
        pytest.param({"hub": Echo(beat_s=80.0, held_s=15.0)}, 5.0, id="held-for-too-long"),
        pytest.param({"hub": Echo(beat_s=99.0, held_s=-1.0)}, 5.0, id="held-for-less-than-no-time"),
        pytest.param({"hub": Echo(beat_s=nan, held_s=0.0)}, 5.0, id="no-number"),
        pytest.param({"hub": Echo(beat_s=99.0, held_s=0.5)}, -1.0, id="an-image-of-the-future"),
        pytest.param({"hub": Echo(beat_s=99.0, held_s=0.5)}, inf, id="an-endless-age"),
        pytest.param({"hub": Echo(beat_s=99.0, held_s=0.5)}, None, id="no-image"),
    ],
)
def test_an_age_that_is_not_known_is_absent(echoes: dict[str, Echo], age_ms: float | None) -> None:
    header = Header(run="r", number=1, age_ms=age_ms, echoes=echoes)
    assert arrival_of(header, "hub", now_s=100.0).image_age_ms(now_s=100.0) is None


@pytest.mark.parametrize(
    "message",
    [b"", b"{}", b"{}\n", b"[]\nx", b'{"run":"r","number":1,"age_ms":"x","echoes":{}}\n', b"\xff\n", b"9\n"],
)
def test_what_is_no_message_is_rejected(message: bytes) -> None:
    with pytest.raises(ValueError, match=r".+"):
        unpacked(message)
