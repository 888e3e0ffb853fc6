"""A video, a folder of images or the rehearsal as the background of a marker."""

import threading
from collections.abc import Iterator
from dataclasses import dataclass

import cv2
import numpy as np
import typer

from server.capture.address import SourceKind, source_from_text
from server.capture.choose import source_from_config
from server.capture.shot import Source
from server.cli.progress import Steps
from server.config import CameraConfig, Config
from server.errors import CaptureError
from server.setup import build_setup, nominal_camera
from tracker.design import Background, joined, places_in
from tracker.edges import GreyImage
from tracker.errors import InvalidInput


@dataclass(frozen=True, slots=True, kw_only=True)
class Film:
    """A background, and which images of its source it is made of.

    Attributes:
        name: of the source.
        numbers: of each image, as the source counts them from 0.
        background: the images and their squares.
    """

    name: str
    numbers: tuple[int, ...]
    background: Background


def film_of(text: str, *, images: int, steps: Steps) -> Film:
    """Images of a source that has an end, at most so many and evenly spread over it.

    Raises:
        InvalidInput: BACKGROUND_WITHOUT_END, or as the source's own error where it gives no image.
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
        kept = evenly_spread(_greys(source, cycle, steps), count=images)
    except CaptureError as error:
        # Nothing is tried again here, and it was no setting.
        remedy = "Give a whole video file or a folder of images with --background."
        raise InvalidInput(error.code, error.message, remedy, error.context) from error
    finally:
        source.close()
    if source.defect is not None:
        typer.echo(f"Note: {source.defect.message}. {source.defect.remedy}", err=True)
    places = []
    for index, (_, grey) in enumerate(kept):
        steps.advance("looking for squares", len(kept))
        places.append(places_in(grey, image_index=index))
    return Film(
        name=address.name,
        numbers=tuple(number for number, _ in kept),
        background=Background(
            images=tuple(grey for _, grey in kept), places=joined(places), camera_of=nominal_camera
        ),
    )


def evenly_spread(images: Iterator[tuple[int, GreyImage]], *, count: int) -> list[tuple[int, GreyImage]]:
    """So many of a stream of unknown length, evenly spread over it; at most twice as many are held."""
    kept: list[tuple[int, GreyImage]] = []
    stride = 1
    for index, image in enumerate(images):
        if index % stride:
            continue
        kept.append(image)
        if len(kept) >= 2 * count:
            kept, stride = kept[::2], 2 * stride
    chosen = np.unique(np.linspace(0, len(kept) - 1, min(count, len(kept))).round().astype(int))
    return [kept[int(index)] for index in chosen]


def _greys(source: Source, most: int | None, steps: Steps) -> Iterator[tuple[int, GreyImage]]:
    given = 0
    while (most is None or given < most) and (shot := source.read()) is not None:
        given += 1
        steps.advance("reading images", most)
        yield shot.number, np.asarray(cv2.cvtColor(shot.image, cv2.COLOR_BGR2GRAY), dtype=np.uint8)
