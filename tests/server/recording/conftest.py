"""One rehearsed drilling for all tests of recordings."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from server.config import Config
from server.setup import Preparation
from tests.server.recording.recorded import Image, RecordedTheatre, made_config, rendered


@pytest.fixture(scope="session")
def drilling() -> tuple[Config, Preparation, list[Image]]:
    """Return the settings, the setup and the images."""
    config = made_config()
    return config, *rendered(config, 16)


@pytest.fixture
def made(drilling: tuple[Config, Preparation, list[Image]], tmp_path: Path) -> Callable[..., RecordedTheatre]:
    """Return a function that creates a theatre for recording."""
    config, preparation, images = drilling

    def make(name: str = "case.mcap") -> RecordedTheatre:
        return RecordedTheatre(path=tmp_path / name, images=images, preparation=preparation, config=config)

    return make


@pytest.fixture(scope="session")
def recorded(
    drilling: tuple[Config, Preparation, list[Image]], tmp_path_factory: pytest.TempPathFactory
) -> Path:
    """Return a recording that begins in the middle of a stream, with an acknowledged alarm."""
    config, preparation, images = drilling
    path = tmp_path_factory.mktemp("recorded") / "case.mcap"
    theatre = RecordedTheatre(path=path, images=images, preparation=preparation, config=config)
    with pytest.MonkeyPatch.context() as patch:
        # Several chunks in half a second.
        patch.setattr("server.recording_file.writer.CHUNK_S", 0.05)
        _drill(theatre)
    return path


def _drill(theatre: RecordedTheatre) -> None:
    for number in range(5):
        theatre.track(number)
    theatre.begin()
    for number in range(5, 8):
        theatre.track(number)
    black = np.zeros_like(theatre.images[0])
    # Long enough for the alarm of an unseen drill, which is acknowledged.
    for number in range(8, 13):
        theatre.track(number, image=black)
    theatre.alarms.acknowledge([one.number for one in theatre.alarms.picture.alarms], by="Anna")
    for number in range(13, 16):
        theatre.track(number)
    theatre.end()
