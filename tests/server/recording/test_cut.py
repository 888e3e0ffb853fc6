"""A section of a recording is a recording, replays exactly, and names its origin."""

import re
from collections.abc import Callable
from pathlib import Path

import pytest
from typer.testing import CliRunner

from server.cli.commands import app
from server.errors import RecordingError
from server.recording.cut import cut_recording
from server.recording.process import STATE_PERIOD_S
from server.recording.replay import check_recording
from server.recording.timeline import make_index
from server.recording_file import RecordingReader, Topic
from server.recording_file.locations import MessageLocations, read_duration_s
from tests.server.recording.recorded import RATE_HZ, RecordedTheatre
from tests.server.recording.reviewed import DRILLED, write_drilling

Make = Callable[..., RecordedTheatre]


@pytest.fixture(scope="module")
def led(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_drilling(tmp_path_factory.mktemp("drilling") / "case.mcap")


@pytest.fixture
def two_states(made: Make, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a recording of 12 images, starting at 3, with a state before image 3 and one before image 10."""
    monkeypatch.setattr("server.recording.process.STATE_PERIOD_S", 5.5 / RATE_HZ)
    monkeypatch.setattr("server.recording.process.MIN_REQUEST_INTERVAL_S", 0.0)
    theatre = made("two.mcap")
    for number in range(3):
        theatre.track(number)
    theatre.begin()
    for number in range(3, 15):
        theatre.track(number)
    theatre.end()
    return theatre.path


def images(path: Path) -> list[tuple[int, int, bytes]]:
    return [
        (one.sequence, one.log_ns, one.content)
        for one in RecordingReader(path).messages()
        if one.topic is Topic.IMAGE
    ]


def replayed(path: Path) -> tuple[int, str]:
    result = CliRunner().invoke(app, ["replay", str(path), "--check"])
    return result.exit_code, result.output


def test_a_state_is_stored_again_after_its_period(two_states: Path) -> None:
    states = [one.sequence for one in MessageLocations(two_states) if one.topic is Topic.STATE]
    assert states == [3, 10]
    assert check_recording(two_states).is_equal
    assert STATE_PERIOD_S == 60.0


@pytest.mark.parametrize(
    ("from_s", "to_s", "first", "last"),
    [(0.0, 3.1 / RATE_HZ, 3, 6), (5.9 / RATE_HZ, 9.1 / RATE_HZ, 3, 12), (8.5 / RATE_HZ, 99.0, 10, 14)],
    ids=["from the begin", "from a state long before", "from the newest state to the end"],
)
def test_a_piece_begins_at_a_state_and_replays_exactly(
    two_states: Path, tmp_path: Path, from_s: float, to_s: float, first: int, last: int
) -> None:
    piece = tmp_path / "piece.mcap"
    words = ["recording", "cut", str(two_states), str(piece), "--from", f"{from_s}", "--to", f"{to_s}"]
    result = CliRunner().invoke(app, words)
    assert result.exit_code == 0, result.output
    assert f"{last - first + 1} images" in result.output
    assert ("where a tracking state is stored" in result.output) == (from_s > 0.0)
    whole = images(two_states)
    assert images(piece) == whole[first - 3 : last - 2]
    code, text = replayed(piece)
    assert code == 0, text
    assert f"poses: identical in {last - first + 1} images" in text
    steps = re.search(r"alarms: identical in (\d+) steps", text)
    assert steps is not None
    assert int(steps[1]) >= last - first
    assert "not compared" not in text
    assert f"note: cut from two.mcap: {from_s:.1f} to {to_s:.1f} s" in text
    index = make_index(piece)
    assert index.is_whole
    assert [one.code for one in index.events if one.kind == "note"] == ["STOPPED"] * (last == 14) + ["CUT"]
    duration_s = read_duration_s(piece)
    assert duration_s is not None
    assert duration_s == pytest.approx((last - first) / RATE_HZ, abs=0.05)
    assert not list(tmp_path.glob("*.part"))


def test_a_changed_byte_is_found(two_states: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # Several chunks: those before the damage are compared.
    monkeypatch.setattr("server.recording_file.copy.CHUNK_BYTES", 1000)
    piece = tmp_path / "piece.mcap"
    cut_recording(two_states, piece, from_s=0.0, to_s=0.2)
    content = bytearray(piece.read_bytes())
    places = [one for one in MessageLocations(piece) if one.topic is Topic.IMAGE]
    content[places[5].offset + places[5].length // 2] ^= 1
    piece.write_bytes(content)
    code, text = replayed(piece)
    assert code == 1
    assert "poses: identical in 5 images" in text
    assert "the file is damaged: a checksum is wrong" in text
    with pytest.raises(RecordingError, match="a checksum is wrong") as found:
        cut_recording(piece, tmp_path / "other.mcap", from_s=0.0, to_s=0.2)
    assert found.value.code == "RECORDING_DAMAGED"
    assert sorted(one.name for one in tmp_path.iterdir()) == ["piece.mcap", "two.mcap"]


def test_a_section_states_its_number_of_missing_images(made: Make, tmp_path: Path) -> None:
    theatre = made("lost.mcap")
    theatre.begin()
    theatre.track(0)
    for number in range(1, 7):
        # The ring has four.
        theatre.track(number, read=False)
    theatre.read()
    theatre.end()
    assert cut_recording(theatre.path, tmp_path / "piece.mcap", from_s=0.0, to_s=9.0).missing_images == 2


def test_without_a_state_a_section_starts_at_the_image_and_cannot_be_replayed(
    led: Path, tmp_path: Path
) -> None:
    piece = tmp_path / "piece.mcap"
    summary = cut_recording(led, piece, from_s=1.75, to_s=2.55)
    assert (summary.images, summary.is_exact) == (8, False)
    assert images(piece) == images(led)[18:26]
    code, text = replayed(piece)
    assert (code, "no state is stored before it" in text) == (1, True)
    index = make_index(piece)
    # Figures as in the whole recording, with the alarms and documents in effect at its start.
    assert index.values.tolist() == make_index(led).values[18:26].tolist()
    assert (index.alarms[:, 1] > 0).all()


@pytest.mark.parametrize(("from_s", "to_s"), [(99.0, 120.0), (2.0, 1.0), (0.01, 0.02)])
def test_a_part_without_images_is_rejected(led: Path, tmp_path: Path, from_s: float, to_s: float) -> None:
    with pytest.raises(RecordingError, match=r"has images from 0 to 3\.9 s") as found:
        cut_recording(led, tmp_path / "piece.mcap", from_s=from_s, to_s=to_s)
    assert found.value.code == "CUT_EMPTY"
    assert len(DRILLED) == 40
    assert list(tmp_path.iterdir()) == []
