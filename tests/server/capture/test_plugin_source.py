"""An image source of another package: nothing counts as live before it is validated."""

import threading
import time
from collections.abc import Callable
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
import pytest

from server.capture.plugin import PluginSource
from server.capture.source_factory import source_from_config
from server.config import Config
from server.errors import CaptureError
from server.live import ImageClock

Open: TypeAlias = "Callable[[str], tuple[PluginSource, list[Camera]]]"
IMAGE = np.arange(2 * 3 * 3, dtype=np.uint8).reshape(2, 3, 3)


class Camera:
    """Product of an entry point: returns what is in `given`, or raises it."""

    def __init__(self, address: str) -> None:
        if address == "unplugged":
            raise OSError("no such device")
        self.address = address
        self.given: list[tuple[object, object] | Exception] = []
        self.is_closed = False

    def read(self) -> tuple[object, object]:
        given = self.given.pop(0)
        if isinstance(given, Exception):
            raise given
        return given

    def close(self) -> None:
        self.is_closed = True
        raise OSError("it was gone already")


@pytest.fixture
def opened(monkeypatch: pytest.MonkeyPatch) -> Open:
    """A source made from settings, and the cameras that the plug-in has opened."""

    def make(address: str = "") -> tuple[PluginSource, list[Camera]]:
        cameras: list[Camera] = []

        def open_camera(given: str) -> Camera:
            cameras.append(Camera(given))
            return cameras[-1]

        monkeypatch.setattr("server.capture.plugin.load_plugin", lambda _group, _name: open_camera)
        config = Config.model_validate({"camera": {"source": f"plugin:xray{address}"}})
        source = source_from_config(config, stop=threading.Event(), first_number=7)
        assert isinstance(source, PluginSource)
        source.open()
        return source, cameras

    return make


def test_it_gets_the_address_after_its_name_which_is_not_shown(
    opened: Open,
) -> None:
    source, (camera,) = opened(":tcp:10.0.0.7:80?password=x")
    assert camera.address == "tcp:10.0.0.7:80?password=x"
    assert source.name == "plugin:xray"


def test_its_images_are_numbered_copied_and_timed(
    opened: Open,
) -> None:
    source, (camera,) = opened("")
    before_s = time.monotonic()
    buffer = IMAGE.copy()
    camera.given = [(buffer, before_s - 0.5), (buffer[:, ::-1], None)]
    first, second = source.read(), source.read()
    buffer[:] = 0
    assert (first.image == IMAGE).all()
    assert (second.image == IMAGE[:, ::-1]).all()
    assert (first.number, second.number) == (7, 8)
    assert first.captured_at_s == first.source_time_s == before_s - 0.5
    assert before_s <= second.captured_at_s <= time.monotonic()
    assert source.camera is not None
    assert source.camera.clock is ImageClock.ARRIVAL


@pytest.mark.parametrize(
    "image",
    [None, IMAGE.astype(np.float32), IMAGE[:, :, 0], IMAGE[:, :, :2], IMAGE[:0], IMAGE.tolist()],
    ids=["none", "float", "grey", "two-channels", "empty", "list"],
)
def test_what_is_no_image_is_rejected(opened: Open, image: npt.NDArray[np.uint8] | None) -> None:
    source, (camera,) = opened("")
    camera.given = [(image, None)]
    with pytest.raises(CaptureError, match="allowed: uint8") as rejected:
        source.read()
    assert rejected.value.code == "PLUGIN_IMAGE_INVALID"


@pytest.mark.parametrize(
    "time_s",
    [
        pytest.param(lambda now_s: now_s + 60.0, id="of-the-future"),
        pytest.param(lambda now_s: now_s - 1.0, id="of-the-image-before"),
        pytest.param(lambda _: float("nan"), id="not-a-number"),
        pytest.param(str, id="text"),
    ],
)
def test_a_time_by_which_an_old_image_could_look_live_is_rejected(
    opened: Open, time_s: Callable[[float], object]
) -> None:
    source, (camera,) = opened("")
    now_s = time.monotonic()
    camera.given = [(IMAGE, now_s - 1.0), (IMAGE, time_s(now_s))]
    source.read()
    with pytest.raises(CaptureError) as rejected:
        source.read()
    assert rejected.value.code == "PLUGIN_TIME_INVALID"


def test_a_camera_that_fails_is_closed_and_opened_again(
    opened: Open,
) -> None:
    source, cameras = opened("")
    cameras[0].given = [ValueError("cable out")]
    with pytest.raises(CaptureError, match="ValueError: cable out"):
        source.read()
    source.open()
    cameras[1].given = [(IMAGE, None)]
    assert cameras[0].is_closed
    assert source.read().number == 7


def test_a_camera_that_cannot_be_opened_gives_the_reason(
    opened: Open,
) -> None:
    with pytest.raises(CaptureError, match="OSError: no such device"):
        opened(":unplugged")


def test_a_plugin_that_is_gone_is_a_problem_of_the_source() -> None:
    config = Config.model_validate({"camera": {"source": "plugin:xray"}})
    source = source_from_config(config, stop=threading.Event())
    with pytest.raises(CaptureError, match="there is no plug-in xray") as rejected:
        source.open()
    assert rejected.value.code == "PLUGIN_NOT_INSTALLED"
