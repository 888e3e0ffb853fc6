"""The video of a recording: its images with their times and the overlay of their recorded results."""

import errno
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import av
import numpy as np
import pytest

from server.alarms import AlarmService, ProcedureFacts
from server.config import Config
from server.errors import RecordingError
from server.overlay import draw_overlay, with_strip
from server.recording.recorded_results import alarms_of, belongs_to, setup_of, snapshot_of
from server.recording.video import write_video
from server.recording_file import RecordingReader, Topic, decoded_value
from server.stream.alarm_messages import AlarmsMessage, alarms_message
from server.stream.snapshot_messages import SnapshotMessage, snapshot_message
from tests.server.recording.recorded import HEIGHT, RATE_HZ, WIDTH, RecordedTheatre
from tests.server.recording.reviewed import DRILLED, PLACES, RUNNING, SOURCE, write_drilling
from tests.server.texts.drilled_rod import UNSEEN, concluded, seen_at
from tests.server.texts.drilled_rod import setup_of as drilled_rod_setup
from tests.tracker.navigation.assessed import drill_reference
from tracker.plan import Channel

Make = Callable[..., RecordedTheatre]


def frames(path: Path) -> list[tuple[float, np.ndarray]]:
    """Return time in s and pixels (h, w, 3), BGR, of each frame."""
    with av.open(str(path)) as container:
        return [
            (frame.time, frame.to_ndarray(format="bgr24"))
            for frame in container.decode(video=0)
            if frame.time is not None
        ]


def test_each_image_has_its_capture_time_and_the_overlay_of_its_results(
    recorded: Path, tmp_path: Path
) -> None:
    summary = write_video(recorded, tmp_path / "case.mp4")
    assert (summary.images, summary.gaps, summary.images_without_overlay, summary.is_whole) == (
        11,
        0,
        0,
        True,
    )
    found = frames(tmp_path / "case.mp4")
    assert [at_s for at_s, _ in found] == pytest.approx([n / RATE_HZ for n in range(11)], abs=2e-5)
    images = [one for one in RecordingReader(recorded).messages() if one.topic is Topic.IMAGE]
    for image, (_, pixels) in zip(images, found, strict=True):
        assert image.image is not None
        assert pixels.shape[1] == WIDTH
        assert 0 < pixels.shape[0] - HEIGHT <= 30
        assert pixels.shape[0] % 2 == 0
    # Seen in the first image, covered in the fifth: the panel shows figures, then text.
    first, fifth = (draw_overlay_of(recorded, number) for number in (0, 4))
    for number, drawn in ((0, first), (4, fifth)):
        plain = np.asarray(images[number].image)
        changed = np.abs(drawn.astype(int) - plain.astype(int)).max(axis=2) > 60
        assert changed.sum() > 2000
        video = found[number][1][:HEIGHT].astype(int)
        # Where the overlay changed the image, the video has the overlay's colour.
        near = np.abs(video - drawn.astype(int)).max(axis=2) < 40
        assert near[changed].mean() > 0.9, number


def draw_overlay_of(path: Path, number: int) -> np.ndarray:
    """Return an image with its overlay, drawn from its messages without the video."""
    messages = list(RecordingReader(path).messages())
    state = next(decoded_value(one.json()) for one in messages if one.topic is Topic.STATE)
    image = [one.image for one in messages if one.topic is Topic.IMAGE][number]
    assert image is not None
    content = [one.content for one in messages if one.topic is Topic.SNAPSHOT][number]
    message = SnapshotMessage.model_validate_json(content)
    setup = setup_of(state.preparation, (WIDTH, HEIGHT))
    assert belongs_to(setup, message)
    return draw_overlay(image, snapshot_of(message, setup))


@pytest.mark.parametrize("mode", ["path", "near", "breach", "hidden"])
def test_what_is_drawn_from_messages_is_what_was_drawn_live(mode: str) -> None:
    setup = drilled_rod_setup()
    sighting = UNSEEN if mode == "hidden" else seen_at(np.array(PLACES[mode]), setup.tools["drill"])
    now_s = 100.0
    alarms = AlarmService(Config(), clock=lambda: now_s)
    alarms.set_facts(ProcedureFacts(navigating=True))
    on_path = seen_at(np.array(PLACES["path"]), setup.tools["drill"])
    for number in range(30):
        now_s = 100.0 + number / 10.0
        seen = {"drill": on_path if number < 10 else sighting}
        snapshot = concluded(setup, drill_reference(), seen, number=number, captured_at_s=now_s)
        now_s += 0.01
        alarms.observe(snapshot, SOURCE, RUNNING)
    picture = alarms.picture
    assert bool(picture.alarms) == (mode != "path")
    width, height = snapshot.size_wh_px
    image = np.full((height, width, 3), 90, dtype=np.uint8)
    message = SnapshotMessage.model_validate_json(snapshot_message(snapshot).model_dump_json())
    shown = AlarmsMessage.model_validate_json(alarms_message(picture, now_s=now_s).model_dump_json())
    assert belongs_to(setup, message)
    for language in ("en", "de"):
        live = draw_overlay(image, snapshot, picture, language=language)
        again = draw_overlay(image, snapshot_of(message, setup), alarms_of(shown), language=language)
        assert (live != image).any()
        # The ellipse is computed from its semi-axes and may be off by a sixteenth of a pixel.
        other = np.abs(again.astype(int) - live.astype(int)).max(axis=2)
        assert other.max() <= 20
        assert (other > 0).sum() < 200


def test_results_of_another_setup_are_not_drawn() -> None:
    setup = drilled_rod_setup()
    sighting = seen_at(np.array(PLACES["path"]), setup.tools["drill"])
    snapshot = concluded(setup, drill_reference(), {"drill": sighting}, number=1, captured_at_s=1.0)
    message = snapshot_message(snapshot)
    channel = setup.channel
    assert isinstance(channel, Channel)
    wider = replace(setup, channel=replace(channel, radius_mm=channel.radius_mm + 0.1))
    assert not belongs_to(wider, message)
    assert not belongs_to(replace(setup, tools={}), message)
    assert not belongs_to(replace(setup, reference="patient"), message)


def test_without_its_setup_an_image_states_that_its_results_are_not_drawn(tmp_path: Path) -> None:
    recording = write_drilling(tmp_path / "case.mcap")
    summary = write_video(recording, tmp_path / "case.mp4", language="de")
    assert (summary.images, summary.images_without_overlay) == (len(DRILLED), len(DRILLED))
    images = [one.image for one in RecordingReader(recording).messages() if one.topic is Topic.IMAGE]
    image = images[0]
    assert image is not None
    note = "ERGEBNISSE NICHT DARGESTELLT · Aufbau fehlt in der Aufzeichnung"
    expected = with_strip(image, "", note=note)[: image.shape[0]].astype(int)
    video = frames(tmp_path / "case.mp4")[0][1][: image.shape[0]].astype(int)
    assert np.abs(video - expected).mean() < 8
    # No figures in the panel at the lower left.
    np.testing.assert_allclose(video[-60:, :80], image[-60:, :80].astype(int), atol=25)


def test_a_time_without_images_shows_the_card_and_no_old_figure(made: Make, tmp_path: Path) -> None:
    theatre = made()
    theatre.begin()
    for number in (0, 1, 60, 61):
        theatre.track(number, image=theatre.images[min(number, 3)])
    theatre.end()
    summary = write_video(theatre.path, tmp_path / "case.mp4")
    assert (summary.images, summary.gaps) == (4, 1)
    found = frames(tmp_path / "case.mp4")
    stale_s = 1 / RATE_HZ + 0.5
    assert [at_s for at_s, _ in found] == pytest.approx([0.0, 1 / 30, stale_s, 2.0, 61 / 30], abs=2e-5)
    card, image = found[2][1][:HEIGHT], found[1][1][:HEIGHT]
    # The card is dark and grey except for its text.
    assert np.median(card) < 50 < np.median(image)


def test_a_cut_recording_gives_its_images_up_to_there(recorded: Path, tmp_path: Path) -> None:
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(recorded.read_bytes()[: recorded.stat().st_size * 9 // 10])
    summary = write_video(cut, tmp_path / "case.mp4")
    assert 0 < summary.images < 11
    assert not summary.is_whole
    assert summary.incomplete_reason
    assert len(frames(tmp_path / "case.mp4")) == summary.images


def test_errors_name_the_remedy(recorded: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(RecordingError, match="cannot be written") as found:
        write_video(recorded, tmp_path / "none" / "case.mp4")
    assert found.value.code == "VIDEO_NOT_WRITTEN"
    monkeypatch.setitem(sys.modules, "av", None)
    with pytest.raises(RecordingError, match="PyAV, which is not installed") as missing:
        write_video(recorded, tmp_path / "case.mp4")
    assert missing.value.code == "VIDEO_ENCODER_MISSING"
    assert not (tmp_path / "case.mp4").exists()


def test_a_video_that_cannot_be_completed_leaves_the_one_before(recorded: Path, tmp_path: Path) -> None:
    target = tmp_path / "case.mp4"
    target.write_bytes(b"before")

    def report(ratio: float, _: str) -> None:
        if ratio > 0.5:
            raise OSError(errno.ENOSPC, "No space left on device")

    with pytest.raises(RecordingError) as caught:
        write_video(recorded, target, report=report)
    assert caught.value.code == "VIDEO_NOT_WRITTEN"
    assert target.read_bytes() == b"before"
    assert list(tmp_path.iterdir()) == [target]
