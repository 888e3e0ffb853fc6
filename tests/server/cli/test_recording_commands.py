"""`coaxial recording export`: the tables, compared with the recording."""

import csv
from pathlib import Path

import av
import pytest
from typer.testing import CliRunner

from server.cli.commands import app
from server.errors import RecordingError
from server.recording_file import RecordingReader, Topic
from tests.server.recording.reviewed import DRILLED, write_drilling


@pytest.fixture(scope="module")
def drilling(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_drilling(tmp_path_factory.mktemp("drilling") / "case.mcap")


def exported(recording: Path, folder: Path) -> dict[str, list[dict[str, str]]]:
    result = CliRunner().invoke(app, ["recording", "export", str(recording), "--to", str(folder)])
    assert result.exit_code == 0, result.output
    tables = {}
    for name in ("poses", "deviations", "alarms"):
        with (folder / f"{name}.csv").open(newline="", encoding="utf-8") as file:
            tables[name] = list(csv.DictReader(file))
    return tables


def test_every_number_is_the_one_of_the_recording(drilling: Path, tmp_path: Path) -> None:
    tables = exported(drilling, tmp_path / "made")
    messages = list(RecordingReader(drilling).messages())
    snapshots = [one.json() for one in messages if one.topic is Topic.SNAPSHOT]
    tools = [row for row in tables["poses"] if row["object"] == "tool"]
    assert len(tools) == len(tables["deviations"]) == len(snapshots) == len(DRILLED)
    for image, (snapshot, pose, off) in enumerate(zip(snapshots, tools, tables["deviations"], strict=True)):
        (tool,) = snapshot["tools"]
        assert int(pose["image"]) == int(off["image"]) == image
        assert int(pose["image_number"]) == snapshot["image_number"]
        assert float(pose["time_s"]) == pytest.approx(image / 10.0)
        if tool["pose"]["kind"] == "absent":
            assert (pose["x_mm"], pose["reason"]) == ("", "MARKER_UNSEEN")
            assert (off["angle_deg"], off["wall_mm"]) == ("", "")
            continue
        recorded = tool["pose"]["camera_from_tool"]
        assert [float(pose[name]) for name in ("x_mm", "y_mm", "z_mm")] == recorded["translation_mm"]
        assert [float(pose[name]) for name in ("r11", "r12", "r13")] == recorded["rotation"][0]
        for name in ("entry_offset_mm", "angle_deg", "depth_mm", "entry_lateral_mm"):
            assert float(off[name]) == tool["deviation"][name]
        assert float(off["wall_mm"]) == tool["assessment"]["figures"]["wall"]["value"]
    events = [
        (event["change"], event["condition"] or "", event["by"])
        for one in messages
        if one.topic is Topic.ALARM_STEP
        for event in one.json()["events"]
    ]
    assert [(row["change"], row["condition"], row["by"]) for row in tables["alarms"]] == events
    assert ("acknowledged", "BREACH", "Anna") in events


def test_a_cut_recording_is_exported_up_to_its_cut_and_another_file_not_at_all(
    drilling: Path, tmp_path: Path
) -> None:
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(drilling.read_bytes()[: drilling.stat().st_size // 2])
    assert 0 < len(exported(cut, tmp_path / "made")["deviations"]) < len(DRILLED)
    cut.write_bytes(b"something else")
    result = CliRunner().invoke(app, ["recording", "export", str(cut), "--to", str(tmp_path / "none")])
    assert result.exit_code != 0
    assert not (tmp_path / "none").exists()


def test_a_video_is_written_beside_or_without_the_tables(drilling: Path, tmp_path: Path) -> None:
    video = tmp_path / "case.mp4"
    result = CliRunner().invoke(app, ["recording", "export", str(drilling), "--video", str(video)])
    assert result.exit_code == 0, result.output
    assert f"{len(DRILLED)} images" in result.output
    with av.open(str(video)) as container:
        assert sum(1 for _ in container.decode(video=0)) == len(DRILLED)
    assert list(tmp_path.iterdir()) == [video]


def test_without_a_target_nothing_is_exported(drilling: Path) -> None:
    result = CliRunner().invoke(app, ["recording", "export", str(drilling)])
    assert result.exit_code == 2
    assert "--video" in result.output


@pytest.mark.parametrize(
    "options",
    [
        ("cut", "--from=0", "--to=1", "{}", "{}"),
        ("export", "{}", "--video", "{}"),
        ("export", "{}", "--sequence", "{}"),
    ],
    ids=["piece", "video", "sequence"],
)
def test_a_recording_is_not_written_over_by_what_is_made_from_it(
    drilling: Path, tmp_path: Path, options: tuple[str, ...]
) -> None:
    recording = tmp_path / "case.mcap"
    recording.write_bytes(drilling.read_bytes())
    given = [one.format(recording) for one in options]
    result = CliRunner().invoke(app, ["recording", *given])
    assert result.exit_code == 2
    assert "is the recording itself" in result.output
    assert recording.read_bytes() == drilling.read_bytes()


@pytest.mark.parametrize(
    ("options", "code"),
    [
        (("export", "{}", "--to", "{}/made"), "TABLE_NOT_WRITTEN"),
        (("export", "{}", "--to", "{}/made", "--format=parquet"), "TABLE_NOT_WRITTEN"),
        (("export", "{}", "--video", "{}/a.mp4"), "VIDEO_NOT_WRITTEN"),
        (("export", "{}", "--sequence", "{}/a.igs.mha"), "SEQUENCE_NOT_WRITTEN"),
        (("cut", "--from=0", "--to=1", "{}", "{}/a.mcap"), "CUT_NOT_WRITTEN"),
    ],
    ids=["tables", "parquet", "video", "sequence", "piece"],
)
def test_what_cannot_be_written_is_named(drilling: Path, options: tuple[str, ...], code: str) -> None:
    # A file is no folder.
    given = [one.format(drilling) for one in options]
    result = CliRunner().invoke(app, ["recording", *given])
    assert isinstance(result.exception, RecordingError)
    assert result.exception.code == code
