"""The tracker of one camera."""

from collections.abc import Callable, Mapping, Sequence
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from tracker.camera import CameraModel
from tracker.errors import InvalidInput
from tracker.marker import (
    MarkerModel,
    ScoreSettings,
    Templates,
    candidate_rounds,
    reject_similar,
    scale_space_of,
    templates_of,
)
from tracker.photometric import textures_of
from tracker.pipeline.fitter import Fitter
from tracker.pipeline.focal_length import FocalLengthMonitor
from tracker.pipeline.idle_search import IdleSearch
from tracker.pipeline.image import RepeatedPatch, grey_of, image_context_of, warm_up_image
from tracker.pipeline.search import Search
from tracker.pipeline.second_prints import SecondPrints
from tracker.pose import (
    ImageContext,
    Prior,
    RollingShutter,
    Seen,
    Sighting,
    Window,
    corners_px_at,
    side_px_of,
    suppress_overlaps,
    window_around,
    with_prediction_error,
)
from tracker.stage_timer import StageTimer

# A longer readout would mean less than five images per second.
MAX_READOUT_S = 0.2
# Images further apart leave time for a complete search of each.
MAX_IDLE_INTERVAL_S = 0.25
# Search radius around the predicted pose, in sides, for a marker that does not fit there.
NEARBY_SIDES = 1.0


class Tracker:
    """Finds any number of markers in images of one camera.

    `step` uses state from previous images; `search` is stateless. Not thread-safe.

    Attributes:
        stage_ms: duration of each stage of the last image, by name; empty without a clock.
        readout_s: the readout time from the constructor.
        focal_length: error of the camera's focal length by the markers in the last images.

    The first tracker of a process loads the compiled kernels, so that no image is delayed by it.

    Args:
        camera: camera model of all images.
        models: marker models with unique names and shapes.
        settings: acceptance thresholds.
        clock: returns seconds, to measure the stages.
        readout_s: time from the first row of an image to the last one; 0 for a global shutter. Poses of
            moving markers are corrected for the shear, and the uncertainty of the motion is added to the
            covariance. A pose refers to the time at which the marker's centre is read.

    Raises:
        InvalidInput: MARKER_NAMES_NOT_UNIQUE, MARKERS_TOO_SIMILAR, or READOUT_INVALID.
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
        reject_similar(models)
        _reject_readout(readout_s)
        self.readout_s = readout_s
        self._readout = RollingShutter(camera=camera, seconds=readout_s) if readout_s > 0.0 else None
        self.camera = camera
        self.models = tuple(models)
        self.settings = settings or ScoreSettings()
        self.stage_ms: Mapping[str, float] = {}
        self._templates = templates_of(self.models)
        self._textures = {model.name: textures_of(model.square) for model in self.models}
        self._priors = {model.name: Prior() for model in models}
        self._patches = {model.name: RepeatedPatch() for model in models}
        for model in self.models:
            # Cached at the first call: fill the caches now, not when a marker is first fitted and verified.
            _ = model.levels
            scale_space_of(model.square)
        self._stages = StageTimer(clock)
        self._fitter = Fitter(camera=camera, settings=self.settings, stages=self._stages)
        self._idle_search = IdleSearch(self._fitter, self._templates_for)
        self._second_prints = SecondPrints(self._fitter, self._templates_for)
        self.focal_length = FocalLengthMonitor(camera, {model.name: model for model in self.models})
        self._stepped_at_s = -np.inf
        if self.models and not Tracker._has_loaded:
            Tracker._has_loaded = True
            self._warm_up()

    def _warm_up(self) -> None:
        """Run the kernels of a search once, because they are compiled or loaded at their first call."""
        image = warm_up_image(self.models[0].square, size_wh_px=self.camera.size_wh_px).image
        pixels, templates = image_context_of(image, self._textures), self._templates[[0]]
        # No image yet: do not call the caller's clock.
        fitter = Fitter(camera=self.camera, settings=self.settings, stages=StageTimer(None))
        model = self.models[0]
        found = Search(pixels, [model], templates, fitter=fitter).run()[model.name]
        if isinstance(found, Seen):
            self.focal_length.measure(pixels, model, found)
        for _ in candidate_rounds(image, templates):
            pass

    def step(
        self,
        image: npt.NDArray[np.uint8],
        *,
        captured_at_s: float,
        full_search: bool = False,
        is_predicted: bool = False,
    ) -> dict[str, Sighting]:
        """Return a sighting of each marker in this image, using state from previous images.

        A marker that was seen is fitted at its predicted pose, or else searched around it. A marker out of
        view is searched by a part of a search in each image (`idle_search`): an unoccluded one is found
        within two images, a blurred or partly occluded one within some more. A marker whose pixels repeat, as
        from a frozen camera, is `Seen`, but adds no evidence for one planar solution.

        A marker with a second print in view is `Unseen` with `MARKER_TWICE`, until one of them was alone in
        view for a second and 16 images. An unoccluded second print is detected within 32 images, a partly
        occluded or small one within 256 (`second_prints`).

        Args:
            image: grey (h, w) or BGR (h, w, 3), uint8, of the camera's size.
            captured_at_s: capture time; an image older than the last one clears the state.
            full_search: search the whole image for each marker that is not seen, regardless of time: for
                recordings, in which no image may be missed.
            is_predicted: whether the image is from a codec with inter prediction (as H.264); the covariance
                then includes the prediction error (`predicted_video`).

        Raises:
            InvalidInput: IMAGE_INVALID, or IMAGE_SIZE_DIFFERS from the camera model's.
        """
        pixels = self._pixels(image)
        # There is no valid state in the first image, or after a gap.
        full_search |= not 0.0 <= captured_at_s - self._stepped_at_s <= MAX_IDLE_INTERVAL_S
        self._stepped_at_s = captured_at_s
        again = {name: patch.is_repeated(pixels.image) for name, patch in self._patches.items()}
        seen: dict[str, Sighting] = {}
        for model in self.models:
            sighting = self._track(pixels, model, captured_at_s, is_repeated=again[model.name])
            if isinstance(sighting, Seen):
                seen[model.name] = sighting
        missing = [model for model in self.models if model.name not in seen]
        if missing:
            seen |= self._found_again(
                pixels, missing, captured_at_s, is_tracking=bool(seen), full_search=full_search
            )
        seen = suppress_overlaps(seen)
        for model in self.models:
            name, prior = model.name, self._priors[model.name]
            now = self._without_shear(model, seen[name], prior, captured_at_s, is_repeated=again[name])
            seen[name] = now
            prior.update(now, captured_at_s, is_repeated=again[name])
            if isinstance(now, Seen) and not again[name]:
                self._patches[name].store(pixels.image, now.corners_px)
        seen = self._second_prints.withhold_duplicates(
            pixels, self.models, seen, captured_at_s, full_search=full_search
        )
        new = {name: one for name, one in seen.items() if isinstance(one, Seen) and not again[name]}
        self.focal_length.take(pixels, new, captured_at_s)
        self._stages.end("judgement")
        self.stage_ms = self._stages.elapsed_ms
        return {model.name: self._stated(seen[model.name], is_predicted) for model in self.models}

    def _stated(self, sighting: Sighting, is_predicted: bool) -> Sighting:
        if is_predicted and isinstance(sighting, Seen):
            return with_prediction_error(sighting, self.camera)
        return sighting

    def _found_again(
        self,
        pixels: ImageContext,
        missing: Sequence[MarkerModel],
        captured_at_s: float,
        *,
        is_tracking: bool,
        full_search: bool,
    ) -> dict[str, Sighting]:
        """Return sightings of the markers that do not fit at their predicted poses."""
        if full_search:
            return self._searched(pixels, missing)
        near = self._found_nearby(pixels, missing, captured_at_s)
        missing = [model for model in missing if model.name not in near]
        if missing and self._idle_search.seems_in_view(pixels, missing, is_tracking=is_tracking):
            return near | self._searched(pixels, missing)
        return near | self._idle_search.unseen(missing)

    def _searched(self, pixels: ImageContext, models: Sequence[MarkerModel]) -> dict[str, Sighting]:
        """Search the whole image."""
        sightings = self._search_of(pixels, models).run()
        self._idle_search.record(sightings)
        return sightings

    def _found_nearby(
        self, pixels: ImageContext, models: Sequence[MarkerModel], captured_at_s: float
    ) -> dict[str, Sighting]:
        """Search around the predicted poses; return those that are seen."""
        seen: dict[str, Sighting] = {}
        for model in models:
            expected = self._priors[model.name].predict(captured_at_s)
            if expected is None:
                continue
            corners = corners_px_at(self.camera, model, expected)
            reach_px = NEARBY_SIDES * side_px_of(corners)
            window = window_around(corners, reach_px=reach_px, size_wh_px=self.camera.size_wh_px)
            if window is None:
                continue
            sighting = self._search_of(pixels, [model], window).run()[model.name]
            if isinstance(sighting, Seen):
                seen[model.name] = sighting
        return seen

    def search(self, image: npt.NDArray[np.uint8]) -> dict[str, Sighting]:
        """Return a sighting of each marker in this image by a search of the whole image, without state.

        If no marker is found with certainty, the illumination may be poor, and a second, much slower search
        follows. `step` omits it, because another image follows. A marker of which a second
        print is in view is `Unseen` with `MARKER_TWICE`.

        Raises:
            InvalidInput: IMAGE_INVALID, or IMAGE_SIZE_DIFFERS from the camera model's.
        """
        pixels = self._pixels(image)
        seen = suppress_overlaps(self._search_of(pixels, self.models).run(thorough=True))
        seen = SecondPrints(self._fitter, self._templates_for).withhold_duplicates(
            pixels, self.models, seen, 0.0, full_search=False
        )
        seen = {model.name: self._without_shear(model, seen[model.name]) for model in self.models}
        self.stage_ms = self._stages.elapsed_ms
        return seen

    def _pixels(self, image: npt.NDArray[np.uint8]) -> ImageContext:
        self._stages.start()
        grey = grey_of(image, size_wh_px=self.camera.size_wh_px)
        self._stages.end("grey")
        return image_context_of(grey, self._textures)

    def _track(
        self, pixels: ImageContext, model: MarkerModel, captured_at_s: float, *, is_repeated: bool
    ) -> Sighting | None:
        """Return the sighting at the predicted pose; None without a prediction."""
        prior = self._priors[model.name]
        expected = prior.predict(captured_at_s, is_repeated=is_repeated)
        if expected is not None and self._readout is not None:
            expected = self._readout.imaged_pose(expected, prior.rates, side_mm=model.side_mm)
        return None if expected is None else self._fitter.near(pixels, model, expected, found_by="track")

    def _without_shear(
        self,
        model: MarkerModel,
        sighting: Sighting,
        prior: Prior | None = None,
        at_s: float = 0.0,
        *,
        is_repeated: bool = False,
    ) -> Sighting:
        """Return the sighting corrected for the rolling shutter; see `RollingShutter.corrected`."""
        if self._readout is None or not isinstance(sighting, Seen):
            return sighting
        return self._readout.corrected(sighting, prior, at_s, side_mm=model.side_mm, is_repeated=is_repeated)

    def _search_of(
        self, pixels: ImageContext, models: Sequence[MarkerModel], window: Window | None = None
    ) -> Search:
        """Return a new search."""
        return Search(pixels, models, self._templates_for(models), fitter=self._fitter, window=window)

    def _templates_for(self, models: Sequence[MarkerModel]) -> Templates:
        return self._templates[[self.models.index(model) for model in models]]


def _reject_readout(readout_s: float) -> None:
    if not 0.0 <= readout_s <= MAX_READOUT_S:
        raise InvalidInput(
            "READOUT_INVALID",
            f"reading an image row by row would take {readout_s * 1e3:g} ms",
            f"Give the value of its data sheet, 0 (a global shutter) to {MAX_READOUT_S * 1e3:g} ms.",
            {"readout_ms": readout_s * 1e3, "max_ms": MAX_READOUT_S * 1000.0},
        )
