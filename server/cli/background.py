"""Background images for marker design, from a video, a folder of images or the rehearsal."""

import threading
from collections.abc import Iterator
from dataclasses import dataclass

import cv2
import numpy as np
import typer

from server.capture.address import SourceKind, source_from_text
from server.capture.shot import Source
from server.capture.source_factory import source_from_config
from server.cli.progress import Steps
from server.config import CameraConfig, Config
from server.errors import CaptureError
from server.setup import build_setup, nominal_camera
from tracker.design import Background, concatenated, places_in
from tracker.edges import GreyImage
from tracker.errors import InvalidInput


@dataclass(frozen=True, slots=True, kw_only=True)
class BackgroundImages:
    """Background images of a source.

    Attributes:
        name: Name of the source.
        numbers: Index of each image in the source, from 0.
        background: The images and the squares found in them.
    """

    name: str
    numbers: tuple[int, ...]
    background: Background


def background_from(text: str, *, images: int, steps: Steps) -> BackgroundImages:
    """Read at most `images` evenly spaced images of a finite source.

    Raises:
        InvalidInput: BACKGROUND_WITHOUT_END, or the code of the source's error if it has no image.
    """
    address = source_from_text(text)
    if address.kind not in (SourceKind.PATH, SourceKind.REHEARSAL):
        raise InvalidInput(
            "BACKGROUND_WITHOUT_END",
            f"'{address.name}' is a {address.kind.value}, which has no end",
            "Record it, and give the video file or a folder of images with --background.",
        )
    config = Config(camera=CameraConfig(source=text, loop=False, rate="fast"))
    theatre = build_setup(config).theatre
    renderer = None if theatre is None else theatre.renderer()
    source = source_from_config(config, stop=threading.Event(), renderer=renderer)
    cycle = None if theatre is None else round(theatre.cycle_s * config.rehearsal.rate_hz)
    try:
        source.open()
        stored = evenly_spaced(_greys(source, cycle, steps), count=images)
    except CaptureError as error:
        # A file is not reopened, and the error is in the input, not in the settings.
        remedy = "Give a readable video file or a folder of images with --background."
        raise InvalidInput(error.code, error.message, remedy, error.context) from error
    finally:
        source.close()
    if source.defect is not None:
        typer.echo(f"Note: {source.defect.message}. {source.defect.remedy}", err=True)
    places = []
    for index, (_, grey) in enumerate(stored):
        steps.advance("finding squares", len(stored))
        places.append(places_in(grey, image_index=index))
    return BackgroundImages(
        name=address.name,
        numbers=tuple(number for number, _ in stored),
        background=Background(
            images=tuple(grey for _, grey in stored), places=concatenated(places), camera_of=nominal_camera
        ),
    )


def evenly_spaced(images: Iterator[tuple[int, GreyImage]], *, count: int) -> list[tuple[int, GreyImage]]:
    """Return `count` evenly spaced images of a stream of unknown length; at most 2 * count are in memory."""
    stored: list[tuple[int, GreyImage]] = []
    stride = 1
    for index, image in enumerate(images):
        if index % stride:
            continue
        stored.append(image)
        if len(stored) >= 2 * count:
            stored, stride = stored[::2], 2 * stride
    chosen = np.unique(np.linspace(0, len(stored) - 1, min(count, len(stored))).round().astype(int))
    return [stored[int(index)] for index in chosen]


def _greys(source: Source, maximum: int | None, steps: Steps) -> Iterator[tuple[int, GreyImage]]:
    given = 0
    while (maximum is None or given < maximum) and (shot := source.read()) is not None:
        given += 1
        steps.advance("reading images", maximum)
        yield shot.number, np.asarray(cv2.cvtColor(shot.image, cv2.COLOR_BGR2GRAY), dtype=np.uint8)
