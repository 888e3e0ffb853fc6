"""`coaxial replay`: what it prints, and its exit status."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from server.cli.commands import app
from server.recording.messages import session_message
from server.recording.replay import Difference, ReplayReport
from server.recording_file import Topic
from tests.server.recording.recorded import made_config
from tests.server.recording_file.written import made_writer, write_images


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "case.mcap"
    writer = made_writer(path)
    session = session_message(
        made_config(),
        case_id="0",
        started_at="2026-01-02T03:04:05Z",
        unix_offset_s=0.0,
        product_version="1.2",
    )
    writer.register(Topic.SESSION)
    writer.add_json(Topic.SESSION, 0.0, session.model_dump_json())
    write_images(writer, 4)
    writer.close()
    return path


def run(*words: str) -> tuple[int, str]:
    result = CliRunner().invoke(app, ["replay", *words])
    return result.exit_code, result.output


def test_it_prints_the_contents_of_a_recording(file: Path) -> None:
    code, text = run(str(file))
    assert code == 0
    assert "recorded 2026-01-02T03:04:05Z from rehearsal" in text
    assert "4 images in 0.3 s" in text
    assert "was cut" not in text
    code, text = run(str(file), "--json")
    assert json.loads(text)["images"] == 4


def test_a_cut_file_is_named_as_one(file: Path) -> None:
    file.write_bytes(file.read_bytes()[:-40])
    assert "the file is incomplete" in run(str(file))[1]


@pytest.mark.parametrize("as_json", [False, True])
def test_the_first_and_the_worst_difference_are_printed_with_their_images(
    file: Path, monkeypatch: pytest.MonkeyPatch, as_json: bool
) -> None:
    report = ReplayReport(images=9, is_whole=True)
    for number, size in ((5, 1e-12), (7, 0.5)):
        difference = Difference(image_number=number, what="tools[0].x", recorded=1.0, replayed=1.0 + size)
        report.poses.add([difference])
    monkeypatch.setattr("server.cli.replay.check_recording", lambda *_, **__: report)
    code, text = run(str(file), "--check", *(["--json"] if as_json else []))
    assert code == 1
    if as_json:
        poses = json.loads(text)["poses"]
        assert (poses["different"], poses["first"]["image_number"], poses["worst"]["image_number"]) == (
            2,
            5,
            7,
        )
        return
    assert "poses: 2 of 9 images differ" in text
    assert "first of these images: image 5: tools[0].x was 1.0" in text
    assert "largest difference: image 7: tools[0].x was 1.0 and is now 1.5, 0.5 apart" in text
    assert "alarms: identical" in text


def test_equal_results_end_with_status_0_and_nothing_compared_with_1(
    file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    code, text = run(str(file), "--check")
    assert code == 1
    assert "no image could be compared" in text
    monkeypatch.setattr(
        "server.cli.replay.check_recording", lambda *_, **__: ReplayReport(images=3, is_whole=True)
    )
    code, text = run(str(file), "--check")
    assert (code, "poses: identical in 3 images" in text) == (0, True)
