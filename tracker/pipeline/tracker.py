"""The tracker of one camera: what each image says of each marker."""

from collections.abc import Callable, Mapping, Sequence
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from tracker.appearance import textures_of
from tracker.camera import CameraModel
from tracker.errors import InvalidInput
from tracker.geometry import Camera, Marker, Rigid
from tracker.marker import (
    MarkerModel,
    ScoreSettings,
    candidate_rounds,
    pictures_of,
    reject_alike,
    templates_of,
)
from tracker.pipeline.fitter import Fitter
from tracker.pipeline.image import Patch, grey_of, pixels_of
from tracker.pipeline.look_out import LookOut
from tracker.pipeline.practice import practice_picture
from tracker.pipeline.search import Search
from tracker.pose import Pixels, Prior, Readout, Seen, Sighting, one_for_each_place
from tracker.stages import Stages

# Slower cameras give under five images a second.
LONGEST_READOUT_S = 0.2


class Tracker:
    """Finds any number of markers in images of one camera.

    `step` uses what it knows from the images before; `search` is stateless. Not to be called from two
    threads at once.

    Attributes:
        stage_ms: time of each stage of the last image, by name; empty where no clock was given.
        readout_s: as it was given.

    The first tracker of a process loads the compiled loops, so that no image has to wait for them.

    Args:
        camera: of all images.
        models: of the markers, each with a name and a shape of its own.
        settings: what is accepted.
        clock: seconds, to time the stages by.
        readout_s: from when the first row of an image is read to the last one; 0 of a global shutter. What
            moves meanwhile is sheared: its pose is told without that, as far as its motion is known, and
            with the rest in its covariance. A pose is of the time at which the marker's centre is read.

    Raises:
        InvalidInput: MARKER_NAMES_NOT_UNIQUE, MARKERS_ALIKE, or READOUT_INVALID.
    """

    _has_loaded: ClassVar[bool] = False

    def __init__(
        self,
        *,
        camera: CameraModel,
        models: Sequence[MarkerModel],
        settings: ScoreSettings | None = None,
        clock: Callable[[], float] | None = None,
        readout_s: float = 0.0,
    ) -> None:
        reject_alike(models)
        _reject_readout(readout_s)
        self.readout_s = readout_s
        self._readout = Readout(camera=camera, seconds=readout_s) if readout_s > 0.0 else None
        self.camera = camera
        self.models = tuple(models)
        self.settings = settings or ScoreSettings()
        self.stage_ms: Mapping[str, float] = {}
        self._templates = templates_of(self.models)
        self._textures = {model.name: textures_of(model.square) for model in self.models}
        self._priors = {model.name: Prior() for model in models}
        self._patches = {model.name: Patch() for model in models}
        for model in self.models:
            # Made when they are first asked for: now, not when the marker is first in doubt.
            pictures_of(model.square)
        self._stages = Stages(clock)
        self._fitter = Fitter(camera=camera, settings=self.settings, stages=self._stages)
        self._look_out = LookOut(self._search_of)
        if self.models and not Tracker._has_loaded:
            Tracker._has_loaded = True
            self._practise()

    def _practise(self) -> None:
        """Run the loops of a search once: they are made, or read, when they are first called."""
        image = practice_picture(self.models[0].square, size_wh_px=self.camera.size_wh_px).image
        pixels, templates = pixels_of(image, self._textures), self._templates[[0]]
        # No image has come: the caller's clock is not asked.
        fitter = Fitter(camera=self.camera, settings=self.settings, stages=Stages(None))
        Search(pixels, self.models[:1], templates, fitter=fitter).to_the_end()
        for _ in candidate_rounds(image, templates):
            pass

    def step(
        self, image: npt.NDArray[np.uint8], *, captured_at_s: float, whole: bool = False
    ) -> dict[str, Sighting]:
        """What this image says of each marker, using what is known from the images before it.

        A marker that was seen is looked for where it is expected; one that is not there is searched for in
        the whole of the same image. A marker that was not seen while others are costs a part of a search:
        it may come into view for a fraction of a second before it is found. A marker whose pixels come
        again, as from a frozen camera, is seen again, and no surer.

        Args:
            image: grey (h, w) or BGR (h, w, 3), uint8, of the camera's size.
            captured_at_s: time of the image; an image that is older than the last one clears what is known.
            whole: search the whole of this image for each marker that is not seen, whatever that costs: for
                recordings, in which no image is to be missed.

        Raises:
            InvalidInput: IMAGE_INVALID, or IMAGE_SIZE_DIFFERS from the camera model's.
        """
        pixels = self._pixels(image)
        again = {name: patch.is_again(pixels.image) for name, patch in self._patches.items()}
        seen: dict[str, Sighting] = {}
        for model in self.models:
            sighting = self._track(pixels, model, captured_at_s, is_again=again[model.name])
            if isinstance(sighting, Seen):
                seen[model.name] = sighting
        missing = [model for model in self.models if model.name not in seen]
        # Where none is in view there is time to look for all.
        at_once = whole or not seen
        lost = [model for model in missing if at_once or self._expected(model, captured_at_s) is not None]
        if lost:
            said = self._search_of(pixels, lost).to_the_end()
            self._look_out.hear(said)
            seen |= said
        lost_names = {model.name for model in lost}
        seen |= self._look_out.look(pixels, [model for model in missing if model.name not in lost_names])
        seen = one_for_each_place(seen)
        for model in self.models:
            name, prior = model.name, self._priors[model.name]
            now = self._undone(model, seen[name], prior, captured_at_s, is_again=again[name])
            seen[name] = now
            prior.learn(now, captured_at_s, is_again=again[name])
            if isinstance(now, Seen) and not again[name]:
                self._patches[name].keep(pixels.image, now.corners_px)
        self.stage_ms = self._stages.taken_ms
        return {model.name: seen[model.name] for model in self.models}

    def search(self, image: npt.NDArray[np.uint8]) -> dict[str, Sighting]:
        """What this image says of each marker: the whole image, no prior, stateless.

        Where none is found for certain the light may be poor, and what is not found is looked for once more:
        that takes many times as long again. A step leaves that out, as another image comes.

        Raises:
            InvalidInput: IMAGE_INVALID, or IMAGE_SIZE_DIFFERS from the camera model's.
        """
        said = self._search_of(self._pixels(image), self.models).to_the_end(thorough=True)
        seen = one_for_each_place(said)
        seen = {model.name: self._undone(model, seen[model.name]) for model in self.models}
        self.stage_ms = self._stages.taken_ms
        return seen

    def _pixels(self, image: npt.NDArray[np.uint8]) -> Pixels:
        self._stages.start()
        grey = grey_of(image, size_wh_px=self.camera.size_wh_px)
        self._stages.end("grey")
        return pixels_of(grey, self._textures)

    def _track(
        self, pixels: Pixels, model: MarkerModel, captured_at_s: float, *, is_again: bool
    ) -> Sighting | None:
        """The marker where it is expected; None when nothing is expected there."""
        prior = self._priors[model.name]
        expected = prior.expected(captured_at_s, is_again=is_again)
        if expected is not None and self._readout is not None:
            expected = self._readout.expected(expected, prior.rates, side_mm=model.side_mm)
        return None if expected is None else self._fitter.near(pixels, model, expected, found_by="track")

    def _expected(self, model: MarkerModel, captured_at_s: float) -> Rigid[Camera, Marker] | None:
        return self._priors[model.name].expected(captured_at_s)

    def _undone(
        self,
        model: MarkerModel,
        sighting: Sighting,
        prior: Prior | None = None,
        at_s: float = 0.0,
        *,
        is_again: bool = False,
    ) -> Sighting:
        """The same without what reading the image row by row did to it; for the rest see `Readout.undone`."""
        if self._readout is None or not isinstance(sighting, Seen):
            return sighting
        return self._readout.undone(sighting, prior, at_s, side_mm=model.side_mm, is_again=is_again)

    def _search_of(self, pixels: Pixels, models: Sequence[MarkerModel]) -> Search:
        """A search that has not begun."""
        which = [self.models.index(model) for model in models]
        return Search(pixels, models, self._templates[which], fitter=self._fitter)


def _reject_readout(readout_s: float) -> None:
    if not 0.0 <= readout_s <= LONGEST_READOUT_S:
        raise InvalidInput(
            "READOUT_INVALID",
            f"reading an image row by row would take {readout_s * 1e3:g} ms",
            f"Give what its data sheet says, 0 (a global shutter) to {LONGEST_READOUT_S * 1e3:g} ms.",
            {"readout_ms": readout_s * 1e3},
        )
