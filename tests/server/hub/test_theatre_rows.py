"""The list of theatres: what is too old is not shown, and says how old it is."""

import json

import pytest

from server.cli.theatres import theatre_table
from server.hub.delays import Arrival
from server.hub.subjects import Leaf
from server.hub.theatres import AlarmRow, TheatrePresence, theatre_rows
from server.hub.watcher import Received

STATE = {
    "source": "running",
    "process": "running",
    "has_image": True,
    "verdict": None,
    "tone": "none",
    "title": {"en": "NO TRACKING", "de": "KEIN TRACKING"},
    "alarms": [
        {"title": {"en": "NO IMAGE", "de": "KEIN BILD"}, "priority": "high", "state": "active", "number": 1}
    ],
}


def received(*, content: bytes = json.dumps(STATE).encode(), transfer_ms: float | None = 4.0) -> Received:
    arrival = Arrival(arrived_s=100.0, transfer_ms=transfer_ms, age_ms=50.0)
    return Received(run="r", number=1, content=content, arrival=arrival)


@pytest.mark.parametrize(
    ("transfer_ms", "now_s", "presence"),
    [
        pytest.param(4.0, 100.5, TheatrePresence.LIVE, id="half-a-second-ago"),
        pytest.param(1990.0, 100.02, TheatrePresence.STALE, id="it-took-two-seconds"),
        pytest.param(4.0, 102.0, TheatrePresence.STALE, id="two-seconds-ago"),
        pytest.param(4.0, 110.0, TheatrePresence.GONE, id="ten-seconds-ago"),
        pytest.param(None, 100.5, TheatrePresence.UNMEASURED, id="never-measured"),
        pytest.param(None, 110.5, TheatrePresence.GONE, id="never-measured-and-gone"),
    ],
)
def test_what_is_not_live_is_not_shown(
    transfer_ms: float | None, now_s: float, presence: TheatrePresence
) -> None:
    (row,) = theatre_rows({("OR-1", Leaf.STATE): received(transfer_ms=transfer_ms)}, now_s=now_s)
    assert row.presence is presence
    is_live = presence is TheatrePresence.LIVE
    alarms = (AlarmRow(priority="high", state="active", title="NO IMAGE"),)
    assert (row.headline, row.alarms) == (("NO TRACKING", alarms) if is_live else ("", ()))
    cells = [next(iter(column.cells)) for column in theatre_table([row]).columns]
    assert (cells[2] == "<= 554 ms old") == is_live
    assert ("s old" in str(cells[1])) == (not is_live and transfer_ms is not None)


def test_the_figures_of_a_verdict_are_not_in_the_list() -> None:
    content = json.dumps({**STATE, "verdict": "near_wall", "title": None}).encode()
    (row,) = theatre_rows({("OR-1", Leaf.STATE): received(content=content)}, now_s=100.1)
    assert row.headline == "NEAR WALL"
    (row,) = theatre_rows({("OR-1", Leaf.STATE): received(content=content)}, now_s=100.1, language="de")
    assert row.headline == "NAHE WAND"


HALF_A_PAIR = json.dumps({**STATE, "tone": "\ud800"}).encode()


@pytest.mark.parametrize("content", [b"", b"[]", b'{"title": 3}', b'{"title": null}', HALF_A_PAIR])
def test_a_state_of_another_version_is_not_one_without_alarms(
    content: bytes,
) -> None:
    (row,) = theatre_rows({("OR-1", Leaf.STATE): received(content=content)}, now_s=100.1)
    assert (row.presence, row.headline, row.alarms) == (TheatrePresence.UNREADABLE, "", ())


def test_theatres_are_sorted_as_people_count() -> None:
    names = ["OR-10", "OR-2", "1A", "Angio"]
    rows = theatre_rows({(name, Leaf.STATE): received() for name in names}, now_s=100.1)
    assert [row.name for row in rows] == ["1A", "Angio", "OR-2", "OR-10"]
