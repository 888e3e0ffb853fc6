"""Video files and folders as sources, complete and damaged."""

import os
import threading
from collections.abc import Iterator
from pathlib import Path

import cv2
import numpy as np
import pytest

from server.capture.folder import FolderSource, natural_order
from server.capture.pacer import Pacer
from server.capture.shot import Shot, Source
from server.capture.source_factory import source_from_config
from server.capture.video_file import VideoFileSource
from server.config import CameraConfig, Config
from server.errors import CaptureError
from server.image_file import decoded
from tests.server.capture.small_videos import cut_video, write_images, write_video


@pytest.fixture
def stop() -> Iterator[threading.Event]:
    event = threading.Event()
    yield event
    event.set()


def level(shot: Shot) -> int:
    return round(float(shot.image.mean()) / 10)


def read_all(source: Source, maximum: int = 100) -> list[Shot]:
    source.open()
    shots: list[Shot] = []
    while len(shots) < maximum and (shot := source.read()) is not None:
        shots.append(shot)
    source.close()
    return shots


def video(path: Path, *, loop: bool = False) -> VideoFileSource:
    return VideoFileSource(path, loop=loop, pacer=None)


def test_a_video_gives_every_image_once_with_its_own_time(tmp_path: Path) -> None:
    shots = read_all(video(write_video(tmp_path / "v.avi")))
    assert [level(shot) for shot in shots] == list(range(8))
    assert [shot.number for shot in shots] == list(range(8))
    assert [shot.source_time_s for shot in shots] == pytest.approx([n / 25 for n in range(8)])


def test_a_looped_video_goes_on_counting_and_its_time_goes_on(tmp_path: Path) -> None:
    shots = read_all(video(write_video(tmp_path / "v.avi"), loop=True), maximum=20)
    assert [level(shot) for shot in shots] == [n % 8 for n in range(20)]
    assert [shot.number for shot in shots] == list(range(20))
    assert [shot.source_time_s for shot in shots] == pytest.approx([n / 25 for n in range(20)])


@pytest.mark.parametrize(
    ("name", "codec", "is_predicted"),
    [
        ("v.avi", "MJPG", False),
        ("v.mkv", "FFV1", False),
        ("v.avi", "HFYU", False),
        ("v.mp4", "mp4v", True),
        ("v.avi", "XVID", True),
        ("v.webm", "VP90", True),
    ],
)
def test_images_of_a_codec_that_predicts_are_marked(
    tmp_path: Path, name: str, codec: str, is_predicted: bool
) -> None:
    shots = read_all(video(write_video(tmp_path / name, codec=codec)))
    assert len(shots) == 8
    assert {shot.is_predicted for shot in shots} == {is_predicted}


@pytest.mark.parametrize("speed", [1.0, 0.5])
def test_a_video_at_its_own_rate_or_slower_is_never_early(
    tmp_path: Path, stop: threading.Event, speed: float
) -> None:
    path = write_video(tmp_path / "v.avi", images=4)
    shots = read_all(VideoFileSource(path, loop=False, pacer=Pacer(stop=stop, speed=speed)))
    began_s = shots[0].captured_at_s
    for shot in shots:
        assert shot.captured_at_s - began_s >= shot.source_time_s / speed - 0.002


def test_a_truncated_video_delivers_its_images_and_reports_the_missing_ones(tmp_path: Path) -> None:
    source = video(cut_video(tmp_path / "cut.avi"))
    shots = read_all(source)
    assert 0 < len(shots) < 20
    assert source.defect is not None
    assert source.defect.code == "VIDEO_FILE_CUT"
    assert f"{len(shots)} of 20 images" in source.defect.message


def test_damaged_jpegs_of_a_video_are_left_out_keep_their_number_and_are_reported(tmp_path: Path) -> None:
    path = write_video(tmp_path / "v.avi")
    packets = path.read_bytes().split(b"00dc")
    # The fourth image ends early in its scan.
    at = packets[5].index(b"\xff\xda") + 20
    packets[5] = packets[5][:at] + b"\xff\xd9" + packets[5][at + 2 :]
    path.write_bytes(b"00dc".join(packets))
    source = video(path)
    shots = read_all(source)
    assert [shot.number for shot in shots] == [level(shot) for shot in shots] == [0, 1, 2, 4, 5, 6, 7]
    assert shots[3].source_time_s == pytest.approx(4 / 25)
    assert source.defect is not None
    assert source.defect.code == "VIDEO_IMAGES_DAMAGED"
    assert f"1 of 4 images of {path} are damaged" in source.defect.message


@pytest.mark.parametrize(
    ("content", "code", "words"),
    [
        pytest.param(b"", "VIDEO_FILE_UNREADABLE", "0 bytes", id="empty"),
        pytest.param(b"only words, no video\n" * 50, "VIDEO_FILE_UNREADABLE", "1050 bytes", id="a-text"),
        pytest.param(None, "SOURCE_NOT_FOUND", "does not exist", id="missing"),
    ],
)
def test_what_is_no_video_is_reported_with_a_remedy(
    tmp_path: Path, content: bytes | None, code: str, words: str
) -> None:
    path = tmp_path / "film.mov"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(CaptureError) as caught:
        video(path).open()
    assert caught.value.code == code
    assert words in caught.value.message
    assert "film.mov" in caught.value.message
    assert caught.value.remedy


def folder(path: Path, *, loop: bool = False) -> FolderSource:
    return FolderSource(path, loop=loop, pacer=None, rate_hz=10.0)


def test_a_folder_is_read_in_the_order_a_person_sorts(tmp_path: Path) -> None:
    images = write_images(tmp_path / "f", {"i10.png": 30, "i2.png": 20, "i1.png": 10, "I3.PNG": 25})
    (images / "notes.txt").write_text("no image")
    shots = read_all(folder(images))
    assert [round(float(shot.image.mean())) for shot in shots] == [10, 20, 25, 30]
    assert [shot.source_time_s for shot in shots] == pytest.approx([0.0, 0.1, 0.2, 0.3])
    names = [Path(name) for name in ("b", "a10", "a9", "10", "9a")]
    assert [path.name for path in sorted(names, key=natural_order)] == ["9a", "10", "a9", "a10", "b"]


@pytest.mark.parametrize(
    ("first_number", "levels"), [(0, [1, 2, 3, 1]), (1, [2, 3, 1, 2]), (5, [3, 1, 2, 3])]
)
def test_after_a_restart_of_the_process_numbers_match_files(
    first_number: int, levels: list[int], tmp_path: Path
) -> None:
    write_images(tmp_path / "f", {"1.png": 10, "2.png": 20, "3.png": 30})
    source = FolderSource(tmp_path / "f", loop=True, pacer=None, first_number=first_number)
    shots = read_all(source, maximum=4)
    assert [level(shot) for shot in shots] == levels
    assert [shot.number for shot in shots] == [first_number + index for index in range(4)]


def test_a_bad_image_is_left_out_and_reported(tmp_path: Path) -> None:
    images = write_images(tmp_path / "f", {"1.png": 10, "3.png": 30})
    (images / "2.png").write_bytes(b"not a picture")
    source = folder(images)
    shots = read_all(source)
    assert [round(float(shot.image.mean())) for shot in shots] == [10, 30]
    assert [(shot.number, round(shot.source_time_s, 3)) for shot in shots] == [(0, 0.0), (2, 0.2)]
    assert source.defect is not None
    assert source.defect.code == "FOLDER_IMAGE_UNREADABLE"
    assert "2.png" in source.defect.message


def test_all_bad_images_are_reported_the_first_ones_by_name(tmp_path: Path) -> None:
    images = write_images(tmp_path / "f", {"10.png": 10, "11.png": 30})
    whole = (images / "10.png").read_bytes()
    for name in ("1", "2", "3", "4"):
        (images / f"{name}.png").write_bytes(whole[: len(whole) // 2])
    source = folder(images)
    assert len(read_all(source)) == 2
    assert source.defect is not None
    assert source.defect.message.startswith("4 images cannot be used: ")
    assert [name in source.defect.message for name in ("1.png", "2.png", "3.png", "4.png")] == [
        *(True, True, True, False)
    ]
    assert source.defect.message.endswith(" and 1 more")


def test_a_bad_image_that_is_replaced_or_taken_away_is_reported_no_more(tmp_path: Path) -> None:
    images = write_images(tmp_path / "f", {"3.png": 30})
    for name in ("1.png", "2.png"):
        (images / name).write_bytes(b"")
    source = folder(images, loop=True)
    source.open()
    source.read()
    assert source.defect is not None
    assert "2 images" in source.defect.message
    write_images(images, {"1.png": 10})
    (images / "2.png").unlink()
    source.read()
    assert source.defect is None


def test_a_folder_that_grows_gives_the_new_images_at_its_next_turn(tmp_path: Path) -> None:
    source = folder(write_images(tmp_path / "f", {"1.png": 10}), loop=True)
    source.open()
    first = source.read()
    write_images(tmp_path / "f", {"2.png": 20})
    later = [source.read() for _ in range(2)]
    assert first is not None
    assert [round(float(shot.image.mean())) for shot in later if shot] == [10, 20]
    assert [shot.number for shot in later if shot] == [1, 2]


def test_a_folder_without_a_usable_image_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "f").mkdir()
    with pytest.raises(CaptureError) as caught:
        folder(tmp_path / "f").open()
    assert caught.value.code == "FOLDER_WITHOUT_IMAGES"
    (tmp_path / "f" / "1.png").write_bytes(b"")
    source = folder(tmp_path / "f", loop=True)
    source.open()
    with pytest.raises(CaptureError) as caught:
        source.read()
    assert caught.value.code == "FOLDER_IMAGE_UNREADABLE"


def test_a_path_is_whatever_it_is_when_it_is_opened(tmp_path: Path, stop: threading.Event) -> None:
    path = tmp_path / "source"
    config = Config(camera=CameraConfig(source=str(path), loop=False, rate="fast"))
    source = source_from_config(config, stop=stop, first_number=5)
    with pytest.raises(CaptureError):
        source.open()
    write_images(path, {"1.png": 10})
    assert [shot.number for shot in read_all(source)] == [5]


def test_a_pipe_is_reported_and_not_waited_for(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe.avi"
    os.mkfifo(pipe)
    with pytest.raises(CaptureError) as caught:
        video(pipe).open()
    assert caught.value.code == "VIDEO_FILE_UNREADABLE"
    assert "a pipe" in caught.value.message


def test_images_that_say_to_be_turned_are_taken_as_the_camera_made_them(tmp_path: Path) -> None:
    picture = np.zeros((12, 20, 3), np.uint8)
    picture[:, :10] = 200
    jpeg = cv2.imencode(".jpg", picture)[1].tobytes()
    # EXIF orientation 6: to be displayed rotated by a quarter turn.
    exif = b"Exif\0\0MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x06\0\0\0\0\0\0"
    turned = jpeg[:2] + b"\xff\xe1" + (len(exif) + 2).to_bytes(2, "big") + exif + jpeg[2:]
    shown = cv2.imdecode(np.frombuffer(turned, np.uint8), cv2.IMREAD_COLOR)
    assert shown is not None
    assert shown.shape == (20, 12, 3)
    (tmp_path / "1.jpg").write_bytes(turned)
    (shot,) = read_all(FolderSource(tmp_path, loop=False, pacer=None))
    assert shot.image.shape == (12, 20, 3)
    # Calibration decodes with the same function, so its parameters apply to tracked images.
    calibrated = decoded(turned)
    assert calibrated is not None
    assert np.array_equal(shot.image, calibrated)
