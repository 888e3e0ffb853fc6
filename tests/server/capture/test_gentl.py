"""harvesters with a real producer, and with a fake of the used API."""

import sys
import threading
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
import pytest

from server.capture.address import source_from_text
from server.capture.industrial import GenTLCameras, IndustrialCameraSource
from server.capture.industrial.gentl import PATH_VARIABLE, producers
from server.capture.modes import WantedMode
from server.live import CameraMode, ImageClock

WANTED = WantedMode(size_wh_px=(320, 240), rate_hz=50.0)


class FakeError(Exception):
    """Of GenApi and GenTL."""


class FakeNode:
    def __init__(self, value: object, *, symbolics: tuple[str, ...] = (), max_value: float = 1e6) -> None:
        self.value = value
        self.symbolics = symbolics
        self.min, self.max, self.inc = 1, max_value, 1


class FakeNodeMap:
    def __init__(self) -> None:
        self.PixelFormat = FakeNode("Mono8", symbolics=("Mono8", "Mono12"))
        self.Width, self.Height = FakeNode(640, max_value=640), FakeNode(480, max_value=480)
        self.AcquisitionFrameRate = FakeNode(10.0, max_value=100.0)

    def has_node(self, name: str) -> bool:
        return hasattr(self, name)


class FakeBuffer:
    def __init__(self, acquirer: "FakeAcquirer", number: int) -> None:
        nodes = acquirer.remote_device.node_map
        width, height = nodes.Width.value, nodes.Height.value
        self._acquirer = acquirer
        # The producer's own memory, refilled after the buffer is returned.
        self.pixels = np.full(width * height, number, dtype=np.uint8)
        component = SimpleNamespace(
            width=width, height=height, num_components_per_pixel=1.0, data=self.pixels, data_format="Mono8"
        )
        self.payload = SimpleNamespace(components=[component])
        self.timestamp_ns = 1_000_000_000 + number * 20_000_000

    def queue(self) -> None:
        self.pixels[:] = 255
        self._acquirer.given_back += 1


class FakeAcquirer:
    min_num_buffers = 1

    def __init__(self) -> None:
        self.remote_device = SimpleNamespace(node_map=FakeNodeMap())
        self.num_buffers = 0
        self.given_back = 0
        self.waiting: list[FakeBuffer] = []
        self.ended: list[str] = []

    def start(self) -> None:
        assert self.num_buffers >= 2

    def try_fetch(self, *, timeout: float) -> FakeBuffer | None:
        assert timeout > 0.0, "0 waits without end"
        return self.waiting.pop(0) if self.waiting else None

    def stop(self) -> None:
        self.ended.append("stop")

    def destroy(self) -> None:
        self.ended.append("destroy")


@pytest.fixture
def fake_library(monkeypatch: pytest.MonkeyPatch) -> FakeAcquirer:
    """Replaces harvesters, whether it is installed or not."""
    acquirer = FakeAcquirer()

    class FakeHarvester:
        device_info_list = (
            SimpleNamespace(vendor="Acme", model="One", serial_number="", id_="acme-1", tl_type="U3V"),
        )

        def add_file(self, file: str) -> None:
            raise AssertionError(file)

        def update(self) -> None:
            pass

        def create(self, index: int) -> FakeAcquirer:
            assert index == 0
            return acquirer

        def reset(self) -> None:
            acquirer.ended.append("reset")

    modules: dict[str, dict[str, Any]] = {
        "harvesters": {},
        "harvesters.core": {"Harvester": FakeHarvester},
        "genicam": {},
        "genicam.genapi": {"GenericException": FakeError},
        "genicam.gentl": {"GenericException": FakeError},
    }
    for name, attributes in modules.items():
        module = ModuleType(name)
        vars(module).update(attributes)
        monkeypatch.setitem(sys.modules, name, module)
    monkeypatch.delenv(PATH_VARIABLE, raising=False)
    return acquirer


def source_of(text: str, wanted: WantedMode = WANTED) -> IndustrialCameraSource:
    return IndustrialCameraSource(
        source_from_text(text), cameras=GenTLCameras(), stop=threading.Event(), wanted=wanted
    )


def test_a_camera_without_a_serial_number_is_known_by_its_producers_name(fake_library: FakeAcquirer) -> None:
    (described,) = GenTLCameras().descriptions()
    assert described.address == "genicam:acme-1"
    assert fake_library.ended == ["reset"]


def test_of_the_images_that_wait_the_newest_is_taken_and_all_buffers_are_given_back(
    fake_library: FakeAcquirer,
) -> None:
    source = source_of("genicam:acme-1")
    source.open()
    fake_library.waiting = [FakeBuffer(fake_library, number) for number in range(1, 6)]
    shot = source.read()
    assert shot is not None
    assert shot.number == 4
    # A copy, not the memory that the producer refills.
    assert np.unique(shot.image).tolist() == [5]
    assert fake_library.given_back == 5
    assert source.camera.clock is ImageClock.DEVICE
    source.close()
    assert fake_library.ended == ["stop", "destroy", "reset"]


def test_a_camera_that_is_not_there_is_reported_and_the_library_let_go(fake_library: FakeAcquirer) -> None:
    with pytest.raises(OSError, match="not connected"):
        GenTLCameras().open("other")
    assert fake_library.ended == ["reset"]


def test_producers_are_found_in_the_folders_of_the_variable(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "vendor.cti").touch()
    (tmp_path / "readme.txt").touch()
    monkeypatch.setenv(PATH_VARIABLE, f"{tmp_path / 'gone'}:{tmp_path}")
    assert producers() == (tmp_path / "vendor.cti",)


@pytest.fixture
def viky(monkeypatch: pytest.MonkeyPatch) -> None:
    """The producer in GenICam's package; neither is in the locks, because of its licence."""
    genicam = pytest.importorskip("genicam", reason="needs coaxial[genicam], which is in no lock")
    pytest.importorskip("harvesters.core", reason="needs coaxial[genicam], which is in no lock")
    monkeypatch.setenv(PATH_VARIABLE, str(Path(genicam.__file__).parent))
    if not producers():
        pytest.skip("needs a version of genicam that brings a producer")


@pytest.mark.usefixtures("viky")
def test_the_library_itself_gives_images_as_they_were_requested() -> None:
    described = GenTLCameras().descriptions()
    assert len(described) == 3
    source = source_of(described[0].address)
    source.open()
    try:
        shots = [source.read() for _ in range(3)]
    finally:
        source.close()
    mode = CameraMode(fourcc="RGBa8", size_wh_px=(320, 240), rate_hz=50.0)
    assert source.camera.requested == source.camera.granted == mode
    assert [shot.image.shape for shot in shots if shot is not None] == [(240, 320, 3)] * 3
    # Reopened, as after a loss.
    source.open()
    assert source.read() is not None
    source.close()
