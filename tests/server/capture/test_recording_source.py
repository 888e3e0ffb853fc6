"""A recording as a source: every image once, at its own time, also from a truncated file."""

import threading
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import pytest

from server.capture.recording import RecordingSource
from server.capture.shot import Shot
from server.capture.source_factory import source_from_config
from server.config import CameraConfig, Config
from server.errors import CaptureError
from server.recording_file import PackedImage, Packing
from tests.server.recording_file.written import made_writer, write_recording


def read_all(source: RecordingSource, maximum: int = 100) -> list[Shot]:
    source.open()
    shots: list[Shot] = []
    while len(shots) < maximum and (shot := source.read()) is not None:
        shots.append(shot)
    source.close()
    return shots


def recording(path: Path, *, loop: bool = False) -> RecordingSource:
    return RecordingSource(path, loop=loop, pacer=None, first_number=7)


def test_a_recording_gives_every_image_once_with_its_own_time(tmp_path: Path) -> None:
    shots = read_all(recording(write_recording(tmp_path / "a.mcap", 5)))
    assert [int(shot.image[4, 4, 1]) for shot in shots] == [0, 1, 2, 3, 4]
    assert [shot.number for shot in shots] == [7, 8, 9, 10, 11]
    assert [shot.source_time_s for shot in shots] == pytest.approx([0.0, 0.1, 0.2, 0.3, 0.4], abs=1e-6)


def test_a_looped_recording_goes_on_counting_and_its_time_goes_on(tmp_path: Path) -> None:
    shots = read_all(recording(write_recording(tmp_path / "a.mcap", 3), loop=True), maximum=7)
    assert [int(shot.image[4, 4, 1]) for shot in shots] == [0, 1, 2, 0, 1, 2, 0]
    times = [shot.source_time_s for shot in shots]
    assert times == sorted(times)
    assert len(set(times)) == 7


def test_a_cut_recording_gives_what_is_there(tmp_path: Path) -> None:
    path = write_recording(tmp_path / "a.mcap", 20)
    path.write_bytes(path.read_bytes()[:2500])
    assert 0 < len(read_all(recording(path))) < 20


def test_a_recording_without_images_and_another_file_are_reported(tmp_path: Path) -> None:
    made_writer(tmp_path / "empty.mcap").close()
    with pytest.raises(CaptureError) as without:
        read_all(recording(tmp_path / "empty.mcap"))
    assert without.value.code == "RECORDING_WITHOUT_IMAGES"
    (tmp_path / "other.mcap").write_bytes(b"no recording")
    with pytest.raises(CaptureError) as other:
        read_all(recording(tmp_path / "other.mcap"))
    assert other.value.code == "RECORDING_NOT_READABLE"
    path = tmp_path / "encoded.mcap"
    writer = made_writer(path)
    encoding = cast(Packing, SimpleNamespace(value="other"))
    writer.add_image(PackedImage(packing=encoding, size_wh_px=(4, 4), content=b"x"), number=0, at_s=0.0)
    writer.close()
    with pytest.raises(CaptureError) as encoded:
        read_all(recording(path))
    assert encoded.value.code == "RECORDING_NOT_READABLE"


def test_the_settings_name_it_by_its_path(tmp_path: Path) -> None:
    path = write_recording(tmp_path / "a.mcap", 3)
    config = Config(camera=CameraConfig(source=str(path), loop=False, rate="fast"))
    source = source_from_config(config, stop=threading.Event())
    source.open()
    shot = source.read()
    assert shot is not None
    assert (shot.number, int(shot.image[4, 4, 1])) == (0, 0)
    source.close()
