"""Replaying a recording gives the same poses and alarms, and reports differences by image."""

from collections.abc import Callable
from dataclasses import replace
from multiprocessing import Pipe
from pathlib import Path

import cv2
import numpy as np
import pytest

from server.alarms import alarm_limits
from server.capture.recording import RecordingSource
from server.cli.replay import describe_file
from server.errors import RecordingError
from server.image_file import decoded
from server.loop.tracking import Tracking
from server.recording.process import follow_server
from server.recording.replay import check_recording
from server.recording_file import RecordingReader, Topic
from server.recording_file.codec import Json
from server.setup import build_setup
from tests.server.loop.test_external_tracking import CONFIG, DRILL, poses
from tests.server.recording.recorded import RecordedTheatre, made_config
from tests.server.recording_file.written import made_writer
from tracker.geometry import Rigid
from tracker.pose import Seen

Make = Callable[..., RecordedTheatre]


def texts(path: Path, topic: Topic) -> list[Json]:
    return [message.json() for message in RecordingReader(path).messages() if message.topic is topic]


def test_what_was_recorded_in_the_middle_of_a_stream_is_replayed_to_the_last_digit(recorded: Path) -> None:
    report = check_recording(recorded)
    assert report.is_equal, (report.poses.first, report.alarms.first)
    assert report.is_whole
    assert report.images == 11
    assert report.steps > 20
    assert (report.unchecked_images, report.missing_images, report.unchecked_steps) == (0, 0, 0)
    assert report.remarks == []
    assert report.changed_versions == []


def test_poses_of_an_external_tracker_are_replayed_without_images(tmp_path: Path) -> None:
    theatre = RecordedTheatre(
        path=tmp_path / "case.mcap",
        images=[np.zeros((360, 640, 3), np.uint8)] * 8,
        preparation=build_setup(CONFIG),
        config=CONFIG,
    )
    theatre.begin()
    for number in range(8):
        moved = poses(depth_mm=1.7 * number, beside_mm=np.pi)
        reported = {
            name: Rigid.from_matrix(one) for name, one in moved.items() if number != 4 or name != DRILL
        }
        theatre.track(number, poses=reported)
    theatre.end()
    report = check_recording(theatre.path)
    assert report.is_equal, (report.poses.first, report.alarms.first)
    assert report.images == 8
    kinds = [one["markers"][0]["sighting"]["kind"] for one in texts(theatre.path, Topic.SNAPSHOT)]
    assert kinds.count("unseen") == 1


def test_the_file_has_poses_transitions_and_acknowledgements(recorded: Path) -> None:
    snapshots = texts(recorded, Topic.SNAPSHOT)
    kinds = [one["markers"][0]["sighting"]["kind"] for one in snapshots]
    assert kinds == ["seen"] * 3 + ["unseen"] * 6 + ["seen"] * 2
    events = [event for step in texts(recorded, Topic.ALARM_STEP) for event in step["events"]]
    changes = [(event["change"], event["condition"], event["by"]) for event in events]
    assert ("raised", "DRILL_UNSEEN", "") in changes
    assert ("acknowledged", "DRILL_UNSEEN", "Anna") in changes


def test_the_file_has_the_poses_of_the_markers_with_their_covariances(recorded: Path) -> None:
    messages = list(RecordingReader(recorded).messages())
    poses = [message.json() for message in messages if message.topic is Topic.POSES]
    snapshots = [message.json() for message in messages if message.topic is Topic.SNAPSHOT]
    assert [one["image_number"] for one in poses] == [one["image_number"] for one in snapshots]
    seen = [one["poses"] for one in poses]
    assert {pose["marker"] for one in seen for pose in one} == {"drill", "reference"}
    # The images without markers.
    assert [] in seen
    for one, snapshot in zip(seen, snapshots, strict=True):
        shown = {marker["name"]: marker["sighting"] for marker in snapshot["markers"]}
        for pose in one:
            wire = shown[pose["marker"]]["camera_from_marker"]
            exact = pose["camera_from_marker"]
            assert exact["translation_mm"] == pytest.approx(wire["translation_mm"], abs=1e-3)
            covariance = np.array(pose["covariance"])
            assert np.array_equal(covariance, covariance.T)
            assert np.linalg.eigvalsh(covariance).min() > 0.0


def test_a_changed_threshold_of_an_alarm_names_the_image(recorded: Path) -> None:
    limits = replace(alarm_limits(made_config()), drill_unseen_after_s=1.0)
    report = check_recording(recorded, limits=limits)
    assert not report.is_equal
    assert report.poses.first is None
    first = report.alarms.first
    assert first is not None
    # Unseen from image 8 on; with the recorded limit of 0.1 s it is unseen for too long in image 10.
    assert first.image_number == 10, str(first)
    assert "image 10" in str(first)


def test_a_pose_in_which_one_digit_differs_is_named_and_the_worst_one_too(
    recorded: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    genuine = Tracking.process

    def moved(self: Tracking, shot: object, **options: object) -> object:
        snapshot = genuine(self, shot, **options)  # pyrefly: ignore[bad-argument-type]
        seen = snapshot.sightings["drill"]
        shift = {6: 1e-13, 7: 0.25}.get(snapshot.image_number, 0.0)
        if not shift:
            return snapshot
        assert isinstance(seen, Seen)
        changed = replace(seen, score_ratio=seen.score_ratio + shift)
        return replace(snapshot, sightings={**snapshot.sightings, "drill": changed})

    monkeypatch.setattr(Tracking, "process", moved)
    report = check_recording(recorded)
    assert report.poses.images == 2
    assert report.poses.first is not None
    assert report.poses.worst is not None
    assert (report.poses.first.image_number, report.poses.worst.image_number) == (6, 7)
    assert report.poses.first.what == "markers[0].sighting.score_ratio"
    assert report.poses.worst.size == pytest.approx(0.25)


def test_images_that_were_overwritten_are_noted_and_the_next_state_resumes_the_check(made: Make) -> None:
    theatre = made()
    theatre.track(0)
    theatre.begin()
    theatre.track(1)
    theatre.track(2)
    # Seven more than the four slots of the ring.
    for number in range(3, 9):
        theatre.track(number, read=False)
    theatre.read()
    assert theatre.recording is not None
    assert theatre.recording.status().missing_images == 2
    theatre.now_s += 5.0
    theatre.read()
    for number in range(9, 12):
        theatre.track(number)
    theatre.end()
    report = check_recording(theatre.path)
    assert report.is_equal
    assert report.missing_images == 2
    assert report.remarks == ["2 tracked images are missing before this one"]
    # Of the 10 in the file, four follow the gap.
    assert (report.images, report.unchecked_images) == (5, 4)


def test_a_server_that_exits_leaves_all_images(made: Make) -> None:
    theatre = made()
    ours, of_server = Pipe()
    of_server.close()
    # Also what it still has to tell the server fails.
    theatre.send = ours.send
    theatre.begin()
    theatre.answer_state()
    for number in range(4):
        theatre.track(number, read=False)
    assert theatre.recording is not None
    follow_server(theatre.recording, ours)
    theatre.recording.close()
    report = check_recording(theatre.path)
    assert (report.images, report.is_equal) == (4, True)


def test_a_recording_that_was_cut_is_replayed_up_to_the_cut(recorded: Path, tmp_path: Path) -> None:
    content = recorded.read_bytes()
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(content[: len(content) * 9 // 10])
    report = check_recording(cut)
    assert report.is_equal
    assert not report.is_whole
    assert 0 < report.images < 11


def test_a_jpeg_of_the_source_is_recorded_as_it_is_and_replayed_exactly(made: Make) -> None:
    theatre = made()
    theatre.begin()
    jpegs = []
    for number in range(4):
        jpegs.append(cv2.imencode(".jpg", theatre.images[number])[1].tobytes())
        theatre.track(number, jpeg=jpegs[-1], image=decoded(jpegs[-1]))
    theatre.end()
    stored = [one.content for one in RecordingReader(theatre.path).messages() if one.topic is Topic.IMAGE]
    assert stored == jpegs
    assert check_recording(theatre.path).is_equal


def test_another_version_is_named_with_what_it_was(recorded: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        "server.recording.replay.library_versions", lambda: {"numpy": "99.0", "opencv-python-headless": "x"}
    )
    report = check_recording(recorded)
    assert [line.split(":")[0] for line in report.changed_versions] == ["numpy", "opencv-python-headless"]
    assert "now 99.0" in report.changed_versions[0]


def test_a_state_of_another_version_compares_nothing_and_gives_the_reason(
    recorded: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("server.recording_file.codec.PACKAGE", "of_another_version.")
    report = check_recording(recorded)
    assert not report.is_equal
    assert (report.images, report.unchecked_images) == (0, 11)
    assert any("the state before image 5 cannot be used" in remark for remark in report.remarks)


def test_a_newer_format_is_rejected(recorded: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("server.recording.replay.FORMAT_VERSION", 0)
    with pytest.raises(RecordingError, match=r"format \d+, this version reads up to 0"):
        check_recording(recorded)


def test_images_of_video_that_predicts_them_are_replayed_and_played_as_such(made: Make) -> None:
    theatre = made()
    theatre.begin()
    for number in range(4):
        theatre.track(number, is_predicted=True)
    theatre.end()
    report = check_recording(theatre.path)
    assert report.is_equal, report.poses.first
    assert report.images == 4
    source = RecordingSource(theatre.path, loop=False, pacer=None)
    source.open()
    assert [shot.is_predicted for shot in iter(source.read, None) if shot] == [True] * 4
    source.close()


def test_no_password_of_the_source_is_in_the_file(made: Make) -> None:
    theatre = made()
    camera = theatre.config.camera.model_copy(update={"source": "rtsp://anna:secret9@10.0.0.2/video"})
    theatre.config = theatre.config.model_copy(update={"camera": camera})
    theatre.begin()
    theatre.end()
    assert b"secret9" not in theatre.path.read_bytes()
    assert texts(theatre.path, Topic.SESSION)[0]["settings"]["camera"]["source"].endswith(
        "***@10.0.0.2/video"
    )


def test_schemas_of_the_wire_are_in_the_file(recorded: Path) -> None:
    content = recorded.read_bytes()
    for name in (b"SnapshotMessage", b"AlarmStepMessage", b"jsonschema"):
        assert name in content


@pytest.mark.parametrize(
    ("topic", "content"),
    [
        pytest.param(Topic.SESSION, "[1]", id="a-list"),
        pytest.param(Topic.NOTE, '{"code": "STATE_MISSING", "message": "", "images": "x"}', id="no-number"),
        pytest.param(Topic.TRACKED, "{}", id="nothing"),
        pytest.param(Topic.NOTE, '["\\ud800"]', id="half-a-character"),
        pytest.param(Topic.NOTE, "[" * 3000, id="nested-without-end"),
    ],
)
def test_what_no_version_has_written_is_no_recording(tmp_path: Path, topic: Topic, content: str) -> None:
    writer = made_writer(tmp_path / "a.mcap")
    writer.register(topic, {"type": "object"})
    writer.add_json(topic, 0.0, content)
    writer.close()
    for read in (check_recording, lambda path: describe_file(path, as_json=True)):
        if read is check_recording or topic is Topic.SESSION or content.startswith("["):
            with pytest.raises(RecordingError) as rejected:
                read(tmp_path / "a.mcap")
            assert rejected.value.code == "RECORDING_NOT_READABLE"
