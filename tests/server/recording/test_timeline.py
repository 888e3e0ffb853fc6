"""The index of a recording: figures as recorded, and times of events."""

import json
from pathlib import Path

import numpy as np
import pytest

from server.recording.review import sampled
from server.recording.timeline import (
    FIGURES,
    STATUSES,
    _Events,
    index_path,
    make_index,
    store_index,
    stored_index,
)
from server.recording_file import RecordingReader, Topic
from server.recording_file.locations import MessageLocations, read_content, read_duration_s
from tests.server.recording.reviewed import DRILLED, RATE_HZ, write_drilling
from tracker.navigation import Status


@pytest.fixture(scope="module")
def drilling(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_drilling(tmp_path_factory.mktemp("drilling") / "case.mcap")


def test_each_message_lies_where_it_is_said_to_be(drilling: Path) -> None:
    read = [(one.topic, one.sequence, one.content) for one in RecordingReader(drilling).messages()]
    locations = MessageLocations(drilling)
    with drilling.open("rb") as file:
        found = [(one.topic, one.sequence, read_content(file, one.offset, one.length)) for one in locations]
    assert found == read
    assert locations.is_whole


def test_a_cut_file_is_indexed_up_to_its_last_whole_message(drilling: Path, tmp_path: Path) -> None:
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(drilling.read_bytes()[: drilling.stat().st_size // 2])
    index = make_index(cut)
    assert not index.is_whole
    assert 0 < len(index) < len(DRILLED)
    assert read_duration_s(cut) is None
    assert read_duration_s(drilling) == pytest.approx(len(DRILLED) / RATE_HZ, abs=0.2)
    whole = make_index(drilling)
    np.testing.assert_array_equal(index.values, whole.values[: len(index)])


def test_images_that_are_lost_again_and_again_are_one_event() -> None:
    events = _Events()
    for at_s in (1.0, 2.0, 6.0, 20.0):
        events.add_note(at_s, {"code": "IMAGES_MISSING"})
    events.add_note(21.0, {"code": "STOPPED"})
    assert [(one.from_s, one.code) for one in events.events(0.0, 30.0)] == [
        (1.0, "IMAGES_MISSING"),
        (20.0, "IMAGES_MISSING"),
        (21.0, "STOPPED"),
    ]


def test_a_document_that_was_not_in_use_before_is_a_step() -> None:
    plan, check = ({"id": kind, "kind": kind, "made_by": "Anna"} for kind in ("plan", "check"))
    events = _Events()
    events.add_documents(1.0, {"documents": [plan]})
    events.add_documents(4.0, {"documents": [plan, check]})
    # Out of date, and valid again.
    events.add_documents(6.0, {"documents": [plan]})
    events.add_documents(8.0, {"documents": [plan, check]})
    found = list(events.events(0.0, 10.0))
    assert [(one.kind, one.from_s, one.code, one.by) for one in found] == [("step", 4.0, "check", "Anna")]


def test_the_figures_are_those_of_the_snapshots_and_gaps_where_they_are_withheld(drilling: Path) -> None:
    index = make_index(drilling)
    assert len(index) == len(DRILLED)
    np.testing.assert_allclose(index.at_s, np.arange(len(DRILLED)) / RATE_HZ, atol=1e-6)
    snapshots = [one.json() for one in RecordingReader(drilling).messages() if one.topic is Topic.SNAPSHOT]
    for number, (mode, snapshot) in enumerate(zip(DRILLED, snapshots, strict=True)):
        assessment = snapshot["tools"][0]["assessment"]
        if mode == "hidden":
            assert np.isnan(index.values[number]).all()
            assert (index.statuses[number] == -1).all()
            continue
        for column, name in enumerate(FIGURES):
            figure = assessment["figures"][name]
            assert index.values[number, column] == figure["value"]
            assert STATUSES[index.statuses[number, column]] == figure["status"]
    wall = STATUSES[index.statuses[DRILLED.index("breach"), FIGURES.index("wall")]]
    assert wall is Status.THROUGH
    assert index.values[DRILLED.index("breach"), FIGURES.index("risk")] == 100.0


def test_the_alarms_of_an_image_are_those_that_were_evaluated_with_it(drilling: Path) -> None:
    index = make_index(drilling)
    steps = [one.json() for one in RecordingReader(drilling).messages() if one.topic is Topic.ALARM_STEP]
    raised = [
        step["image_number"] - 1000
        for step in steps
        for event in step["events"]
        if (event["change"], event["condition"]) == ("raised", "BREACH")
    ]
    with drilling.open("rb") as file:
        before, then = (
            read_content(file, *map(int, index.alarms[number])).decode()
            for number in (raised[0] - 1, raised[0])
        )
    assert '"BREACH"' not in before
    assert '"BREACH"' in then


def test_what_happened_has_its_begin_end_and_person(drilling: Path) -> None:
    events = make_index(drilling).events
    (navigation,) = [one for one in events if one.kind == "navigation"]
    assert navigation.from_s == pytest.approx(0.5, abs=0.11)
    assert navigation.to_s == pytest.approx(3.6, abs=0.11)
    (withheld,) = [one for one in events if one.kind == "withheld"]
    assert (withheld.from_s, withheld.to_s) == pytest.approx((1.0, 1.8))
    (breach,) = [one for one in events if one.kind == "alarm" and one.code == "BREACH"]
    assert 2.4 <= breach.from_s < 3.0
    assert breach.to_s is not None
    assert 3.0 <= breach.to_s <= 4.0
    acknowledged = [one for one in events if one.kind == "acknowledgement"]
    assert {one.by for one in acknowledged} == {"Anna"}
    (mark,) = [one for one in events if one.kind == "mark"]
    assert (mark.code, mark.by) == ("circle", "Dr Sato")
    assert mark.from_s == pytest.approx(3.31)
    assert [one.code for one in events if one.kind == "note"][-1] == "STOPPED"
    assert [one.from_s for one in events] == sorted(one.from_s for one in events)


def test_images_that_share_a_sample_give_the_worst_of_each_figure(drilling: Path) -> None:
    index = make_index(drilling)
    every = sampled(index, 0.0, 10.0, 1000)
    np.testing.assert_array_equal(every.values, index.values)
    few = sampled(index, 0.0, 4.0, 4)
    assert len(few.numbers) <= 6
    entry, wall, depth, risk = (FIGURES.index(name) for name in ("entry", "wall", "depth", "risk"))
    assert np.nanmax(few.values[:, entry]) == np.nanmax(index.values[:, entry])
    assert np.nanmin(few.values[:, wall]) == np.nanmin(index.values[:, wall])
    assert few.values[-1, depth] == index.values[-1, depth]
    # The newest image is back on the path.
    assert sampled(index, 0.0, 4.0, 2).values[1, risk] == 100.0
    part = sampled(index, 2.0, 3.0, 1000)
    assert part.at_s[0] < 2.0
    assert part.at_s[-1] > 3.0
    assert len(part.numbers) <= 13


def test_an_index_is_stored_beside_its_recording_and_is_of_this_file_alone(tmp_path: Path) -> None:
    path = write_drilling(tmp_path / "case.mcap", DRILLED[:12])
    assert stored_index(path) is None
    reports: list[float] = []
    assert store_index(lambda ratio, _: reports.append(ratio), recording=str(path)) == {"images": 12}
    assert 0.0 < reports[0] <= reports[-1] <= 1.0
    stored, made = stored_index(path), make_index(path)
    assert stored is not None
    assert stored.events == made.events
    np.testing.assert_array_equal(stored.images, made.images)
    whole = index_path(path).read_bytes()
    for damaged in (b"damaged", whole[:-30], whole.replace(b"PK\x03\x04", b"PK\x03\x05", 1)):
        index_path(path).write_bytes(damaged)
        assert stored_index(path) is None
    store_index(lambda *_: None, recording=str(path))
    path.write_bytes(path.read_bytes() + b"more")
    assert stored_index(path) is None


def test_a_damaged_result_is_left_out(tmp_path: Path) -> None:
    path = write_drilling(tmp_path / "case.mcap", DRILLED[:4])
    second = [one for one in MessageLocations(path) if one.topic is Topic.SNAPSHOT][1]
    content = bytearray(path.read_bytes())
    content[second.offset : second.offset + 4] = b"\xff\xff\xff\xff"
    path.write_bytes(content)
    index = make_index(path)
    assert len(index) == 3
    third = index.snapshots[1]
    with path.open("rb") as file:
        assert json.loads(read_content(file, *map(int, third)))["image_number"] == 1002
