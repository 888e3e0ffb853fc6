"""Views of a board are captured automatically from the live images of a rehearsal."""

import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest

from server.live import CameraStatus, ImageClock, Instant, LiveHub, Problem, SourceState, SourceStatus
from server.procedure.board_collection import MESSAGES, BoardCollection
from server.texts import phrase_text
from tracker.camera import Board, CameraControl
from tracker.errors import InvalidInput
from tracker.navigation import NavigationSnapshot
from tracker.rehearsal import BoardKind, Scene, Theatre, TheatreSettings
from tracker.rehearsal.boards import BOARD_FROM_KIND, HOLD_S, MOVE_S

InstantOf = Callable[..., Instant]
SnapshotOf = Callable[..., NavigationSnapshot]
SIZE = (640, 360)
BOARD: Board = BOARD_FROM_KIND[BoardKind.CHECKERBOARD]
DEADLINE_S = 60.0


@lru_cache(maxsize=1)
def images() -> tuple[np.ndarray, ...]:
    """Two images of the board in each of its first four places."""
    settings = TheatreSettings(seed=3, size_wh_px=SIZE, scene=Scene.BOARD, board=BoardKind.CHECKERBOARD)
    renderer = Theatre(settings).renderer()
    times_s = [place * (HOLD_S + MOVE_S) + late_s for place in range(4) for late_s in (0.3, 0.6)]
    return tuple(renderer.image_at(at_s) for at_s in times_s)


class Camera:
    """Publishes images one after another, each when the previous one was processed."""

    def __init__(self, instant_of: InstantOf, snapshot_of: SnapshotOf) -> None:
        self.hub = LiveHub()
        self._instant_of, self._snapshot_of = instant_of, snapshot_of
        self._number = 0
        self.collection = BoardCollection(self.hub, BOARD)

    def show(self, image: np.ndarray | None, source: SourceStatus | None = None) -> None:
        self._number += 1
        at_s = self._number * 0.3
        snapshot = self._snapshot_of(image_number=self._number, captured_at_s=at_s)
        instant = self._instant_of(self._number, snapshot=None if image is None else snapshot, source=source)
        before = self.collection.status.message
        self.hub.publish(replace(instant, image=image))
        wanted = -1 if image is None else self._number
        deadline_s = time.monotonic() + DEADLINE_S
        while self.collection.status.problem is None and not (
            self.collection.status.message != before
            if source
            else self.collection.status.image_number == wanted
        ):
            assert time.monotonic() < deadline_s, "the image was not looked at"
            time.sleep(0.001)


@pytest.fixture
def camera(instant_of: InstantOf, snapshot_of: SnapshotOf) -> Iterator[Camera]:
    camera = Camera(instant_of, snapshot_of)
    yield camera
    camera.collection.stop()


def test_each_place_is_taken_once_when_the_board_holds_still(camera: Camera) -> None:
    message = []
    for image in images():
        camera.show(image)
        message.append(camera.collection.status.message)
    assert message[0] == "board found: hold it still"
    assert message[1] == "taken"
    assert [one.name for one in camera.collection.taken] == ["image 2", "image 4", "image 6", "image 8"]
    status = camera.collection.status
    assert status.size_wh_px == SIZE
    assert len(status.points_px) == 70
    assert status.progress is not None
    assert status.progress.views == 4
    assert status.progress.missing


def test_without_a_board_or_a_picture_it_reports_that_and_waits(camera: Camera) -> None:
    camera.show(np.full((SIZE[1], SIZE[0], 3), 90, dtype=np.uint8))
    empty = camera.collection.status
    assert empty.points_px.shape == (0, 2)
    assert "hold it still" not in empty.message
    camera.show(None)
    assert camera.collection.status.message == "there is no image"
    gone = Problem(code="CAMERA_GONE", message="the camera 0 gives no image", remedy="Plug it in.")
    camera.show(None, SourceStatus(name="0", state=SourceState.RECONNECTING, problem=gone))
    assert camera.collection.status.message == "there is no image: the camera 0 gives no image"
    camera.show(None, SourceStatus(name="0", state=SourceState.ENDED))
    assert camera.collection.status.message == "there is no image: the source has ended"
    for image in images()[:2]:
        camera.show(image)
    assert len(camera.collection.taken) == 1


def test_images_of_another_size_end_it_and_what_was_taken_stays(camera: Camera) -> None:
    for image in images()[:2]:
        camera.show(image)
    camera.show(np.ascontiguousarray(np.pad(images()[2], ((0, 40), (0, 40), (0, 0)))))
    problem = camera.collection.status.problem
    assert problem is not None
    assert problem.code == "IMAGE_SIZE_CHANGED"
    assert "680x400" in problem.message
    assert len(camera.collection.taken) == 1


def test_a_lens_that_moves_between_two_views_ends_it(camera: Camera) -> None:
    def source(focus: int) -> SourceStatus:
        controls = {CameraControl.FOCUS: focus, CameraControl.GAIN: focus}
        status = CameraStatus(clock=ImageClock.DRIVER, controls=controls)
        return SourceStatus(name="0", state=SourceState.RUNNING, camera=status)

    for image in images()[:2]:
        camera.show(image, source(45))
    assert camera.collection.controls == {CameraControl.FOCUS: 45, CameraControl.GAIN: 45}
    camera.show(images()[2], source(46))
    camera.show(images()[3], source(46))
    problem = camera.collection.status.problem
    assert problem is not None
    assert problem.code == "CAMERA_CHANGED"
    assert "focus of the camera changed from 45 to 46" in problem.message
    assert len(camera.collection.taken) == 1


def test_another_camera_between_two_views_ends_it(camera: Camera) -> None:
    def source(device: str) -> SourceStatus:
        status = CameraStatus(clock=ImageClock.DRIVER, device=device)
        return SourceStatus(name="0", state=SourceState.RUNNING, camera=status)

    for image in images()[:2]:
        camera.show(image, source("Webcam A"))
    assert camera.collection.device == "Webcam A"
    camera.show(images()[2], source("Webcam B"))
    camera.show(images()[3], source("Webcam B"))
    problem = camera.collection.status.problem
    assert problem is not None
    assert problem.code == "CAMERA_DIFFERS"
    assert len(camera.collection.taken) == 1


def test_an_image_that_was_taken_by_hand_counts_as_it_is(camera: Camera) -> None:
    camera.collection.add(images()[0], name="by hand")
    camera.collection.add(images()[0], name="again")
    assert [one.name for one in camera.collection.taken] == ["by hand", "again"]
    with pytest.raises(InvalidInput) as caught:
        camera.collection.add(np.full((360, 640, 3), 90, dtype=np.uint8), name="empty.png")
    assert caught.value.code == "BOARD_NOT_FOUND"
    assert "empty.png" in caught.value.message


def test_there_is_an_end_to_how_many_are_kept(camera: Camera, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("server.procedure.board_collection.MAX_VIEWS", 2)
    for index in range(2):
        camera.collection.add(images()[0], name=str(index))
    with pytest.raises(InvalidInput, match="2 views have been taken"):
        camera.collection.add(images()[0], name="one more")


@pytest.mark.parametrize("english", MESSAGES.values())
def test_each_result_of_an_image_has_german(english: str) -> None:
    assert phrase_text("collection_message", english)["de"] != english


def test_advice_for_further_views_is_german() -> None:
    advice = "Tilt the board by 20 degrees or more, its left edge away from you (7 so far)."
    assert phrase_text("view_advice", advice)["de"] == (
        "Die Tafel um 20° oder mehr neigen, die linke Kante von der Person weg (bisher 7°)."
    )
    corners = "Hold the board into the top left, bottom right of the image."
    assert phrase_text("view_advice", corners)["de"] == (
        "Die Tafel in diese Ecken des Bildes halten: oben links, unten rechts."
    )
    assert phrase_text("view_advice", "Sing.") == {"en": "Sing.", "de": "Sing."}
