"""The stages of the tracker in order, and nothing else."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import ClassVar

import cv2
import numpy as np
import numpy.typing as npt

from tracker.appearance import textures_of
from tracker.camera import CameraModel
from tracker.edges import GreyImage, edgels_of, gradient_of
from tracker.errors import InvalidInput
from tracker.geometry import Camera, Marker, Rigid
from tracker.marker import (
    Candidate,
    MarkerModel,
    ScoreSettings,
    candidate_rounds,
    pictures_of,
    practice_image,
    refuse_alike,
    templates_of,
)
from tracker.pose import (
    FoundBy,
    Pixels,
    Prior,
    Scene,
    Seen,
    Sighting,
    Unseen,
    UnseenReason,
    judged,
    occurrence_near,
    one_for_each_place,
    pose_from_corners,
    window_around,
    with_target,
    worth_of,
)
from tracker.regions import noise_grey
from tracker.stages import Stages

# Corners of an outline are intersections of fitted lines: off by a pixel, two on a bent sheet.
SEARCH_REACH_PX = 2.5
# A hand in theatre moves the marker by a few pixels from image to image; prediction takes most of it.
TRACK_REACH_PX = 6.0
MOST_FITS = 2
# Seen (2), with score and target score of 0.9 on average.
CERTAIN_WORTH = 3.8
PIXELS_FOR_NOISE = 125_000
# While others are tracked, what is out of view costs one part of a search in so many of so many images: most
# images cost no more than what is in view.
SEARCHED_IMAGES, OF_IMAGES = 2, 5


@dataclass(slots=True)
class _Watch:
    """A search of one image for markers that are out of view, spread over the images after it. Mutable.

    Attributes:
        pixels: of the image that is searched, which may be some images old.
        models: what is looked for.
        rounds: candidates for each of them, at rising cost.
        best: what was made of them until now.
        waiting: models whose candidates of this round have not been looked at.
        images: how many have passed since it began.
    """

    pixels: Pixels
    models: list[MarkerModel]
    rounds: Iterator[list[list[Candidate]]]
    best: dict[str, Sighting]
    waiting: list[tuple[MarkerModel, list[Candidate]]] = field(default_factory=list)
    images: int = 0


class Tracker:
    """Finds any number of markers in images of one camera.

    `step` uses what it knows from the images before; `search` is stateless. Not to be called from two
    threads at once.

    Attributes:
        stage_ms: time of each stage of the last image, by name; empty where no clock was given.

    The first tracker of a process loads the compiled loops, so that no image has to wait for them.

    Raises:
        InvalidInput: MARKER_NAMES_NOT_UNIQUE, or MARKERS_ALIKE.
    """

    _has_loaded: ClassVar[bool] = False

    def __init__(
        self,
        *,
        camera: CameraModel,
        models: Sequence[MarkerModel],
        settings: ScoreSettings | None = None,
        clock: Callable[[], float] | None = None,
    ) -> None:
        refuse_alike(models)
        self.camera = camera
        self.models = tuple(models)
        self.settings = settings or ScoreSettings()
        self.stage_ms: Mapping[str, float] = {}
        self._templates = templates_of(self.models)
        self._textures = {model.name: textures_of(model.square) for model in self.models}
        self._priors = {model.name: Prior() for model in models}
        self._watch: _Watch | None = None
        # What the last whole search said of each marker that it did not find.
        self._unseen = {model.name: Unseen(reason=UnseenReason.NO_CANDIDATE) for model in models}
        for model in self.models:
            # Made when they are first asked for: now, not when the marker is first in doubt.
            pictures_of(model.square)
        self._stages = Stages(None)
        if self.models and not Tracker._has_loaded:
            Tracker._has_loaded = True
            self._practise()
        self._stages = Stages(clock)

    def _practise(self) -> None:
        """Run the loops of a search once: they are made, or read, when they are first called."""
        image = practice_image(self.models[0].square, size_wh_px=self.camera.size_wh_px)
        self._search(self._pixels(image), self.models[:1])
        for _ in candidate_rounds(image, self._templates[[0]]):
            pass

    def step(self, image: npt.NDArray[np.uint8], *, captured_at_s: float) -> dict[str, Sighting]:
        """What this image says of each marker, using what is known from the images before it.

        A marker that was seen is looked for where it is expected; one that is not there is searched for in
        the whole of the same image. A marker that was not seen while others are costs a part of a search:
        it may come into view for a fraction of a second before it is found.

        Args:
            image: grey (h, w) or BGR (h, w, 3), uint8, of the camera's size.
            captured_at_s: time of the image; an image that is older than the last one clears what is known.

        Raises:
            InvalidInput: IMAGE_INVALID, or IMAGE_SIZE_DIFFERS from the camera model's.
        """
        self._stages.start()
        grey = self._grey(image)
        pixels = self._pixels(grey)
        seen: dict[str, Sighting] = {}
        for model in self.models:
            sighting = self._track(pixels, model, captured_at_s)
            if isinstance(sighting, Seen):
                seen[model.name] = sighting
        missing = [model for model in self.models if model.name not in seen]
        # Where none is in view there is time to look for all.
        lost = [model for model in missing if not seen or self._expected(model, captured_at_s) is not None]
        lost_names = {model.name for model in lost}
        if lost:
            said = self._search(pixels, lost)
            self._keep_unseen(said)
            seen |= said
        seen |= self._look_out_for(pixels, [model for model in missing if model.name not in lost_names])
        seen = one_for_each_place(seen)
        for name, prior in self._priors.items():
            prior.learn(seen[name], captured_at_s)
        self.stage_ms = self._stages.taken_ms
        return {model.name: seen[model.name] for model in self.models}

    def search(self, image: npt.NDArray[np.uint8]) -> dict[str, Sighting]:
        """What this image says of each marker: the whole image, no prior, stateless.

        Raises:
            InvalidInput: IMAGE_INVALID, or IMAGE_SIZE_DIFFERS from the camera model's.
        """
        self._stages.start()
        seen = one_for_each_place(self._search(self._pixels(self._grey(image)), self.models))
        self.stage_ms = self._stages.taken_ms
        return seen

    def _grey(self, image: npt.NDArray[np.uint8]) -> GreyImage:
        if image.dtype != np.uint8 or not (image.ndim == 2 or (image.ndim == 3 and image.shape[2] == 3)):
            raise InvalidInput(
                "IMAGE_INVALID",
                f"an image is {image.dtype} of shape {image.shape}, needed uint8 (h, w) or (h, w, 3)",
                "Give grey or BGR images with 8 bits.",
            )
        height, width = image.shape[:2]
        if (width, height) != self.camera.size_wh_px:
            wanted = self.camera.size_wh_px
            raise InvalidInput(
                "IMAGE_SIZE_DIFFERS",
                f"the image is {width}x{height} px, the camera was calibrated at {wanted[0]}x{wanted[1]} px",
                "Set the camera to the size it was calibrated at, or calibrate it at this size.",
                {"width_px": width, "height_px": height, "calibrated_wh_px": list(wanted)},
            )
        grey = np.ascontiguousarray(image) if image.ndim == 2 else cv2.cvtColor(image, cv2.COLOR_BGR2GRAY)
        self._stages.end("grey")
        return np.asarray(grey, dtype=np.uint8)

    def _pixels(self, grey: GreyImage) -> Pixels:
        # Noise is alike everywhere: some rows tell it.
        every = max(grey.size // PIXELS_FOR_NOISE, 1)
        return Pixels(image=grey, noise_grey=noise_grey(grey[::every]), textures=self._textures)

    def _track(self, pixels: Pixels, model: MarkerModel, captured_at_s: float) -> Sighting | None:
        """The marker where it is expected; None when nothing is expected there."""
        expected = self._expected(model, captured_at_s)
        return None if expected is None else self._near(pixels, model, expected, found_by="track")

    def _expected(self, model: MarkerModel, captured_at_s: float) -> Rigid[Camera, Marker] | None:
        return self._priors[model.name].expected(captured_at_s)

    def _near(
        self, pixels: Pixels, model: MarkerModel, start: Rigid[Camera, Marker], *, found_by: FoundBy
    ) -> Sighting | None:
        """What stands at about this pose; None when it would be outside the image, or nothing fits there."""
        corners = self.camera.px_from_camera(start.move_points(model.corners_mm))
        window = window_around(corners, reach_px=TRACK_REACH_PX, size_wh_px=self.camera.size_wh_px)
        if window is None:
            return None
        expected = start if found_by == "track" else None
        left, top, right, bottom = window
        part = np.ascontiguousarray(pixels.image[top:bottom, left:right])
        gradient = gradient_of(part, left_px=left, top_px=top)
        self._stages.end("gradient")
        reach = SEARCH_REACH_PX if expected is None else TRACK_REACH_PX
        found = occurrence_near(self.camera, model, gradient, start, first_reach_px=reach, expected=expected)
        self._stages.end("fit")
        if found is None:
            return None
        found = with_target(self.camera, model, gradient, edgels_of(gradient), found)
        self._stages.end("score")
        scene = Scene(
            camera=self.camera,
            model=model,
            pixels=pixels,
            window=part,
            gradient=gradient,
            settings=self.settings,
            expected=expected,
        )
        sighting = judged(scene, found)
        self._stages.end("judgement")
        return sighting

    def _search(self, pixels: Pixels, models: Sequence[MarkerModel]) -> dict[str, Sighting]:
        watch = self._watch_of(pixels, models)
        while self._go_on(watch):
            if all(worth_of(sighting) > CERTAIN_WORTH for sighting in watch.best.values()):
                break
        return watch.best

    def _watch_of(self, pixels: Pixels, models: Sequence[MarkerModel]) -> _Watch:
        """A search that has not begun."""
        which = [self.models.index(model) for model in models]
        return _Watch(
            pixels=pixels,
            models=list(models),
            rounds=candidate_rounds(pixels.image, self._templates[which]),
            best={model.name: Unseen(reason=UnseenReason.NO_CANDIDATE) for model in models},
        )

    def _go_on(self, watch: _Watch) -> bool:
        """A part of a search: a round's candidates, or a look at those of one model; False at the end."""
        if not watch.waiting:
            candidates = next(watch.rounds, None)
            self._stages.end("candidates")
            watch.waiting = [pair for pair in zip(watch.models, candidates or [], strict=False) if pair[1]]
            return candidates is not None
        model, own = watch.waiting.pop(0)
        if worth_of(watch.best[model.name]) <= CERTAIN_WORTH:
            found = self._search_one(watch.pixels, model, own)
            watch.best[model.name] = max(watch.best[model.name], found, key=worth_of)
        return True

    def _look_out_for(self, pixels: Pixels, models: list[MarkerModel]) -> dict[str, Sighting]:
        """What can be said of markers out of view for a part of the cost of a search.

        An image is searched part after part while others pass. What is found in it has come into view: only
        then the image at hand is searched as a whole.
        """
        if not models:
            self._watch = None
            return {}
        if self._watch is None or list(self._watch.best) != [model.name for model in models]:
            # The caller may write the next image into the same memory.
            self._watch = self._watch_of(replace(pixels, image=pixels.image.copy()), models)
        watch = self._watch
        is_turn = SEARCHED_IMAGES * watch.images % OF_IMAGES < SEARCHED_IMAGES
        watch.images += 1
        is_over = is_turn and not self._go_on(watch)
        if is_over:
            self._keep_unseen(watch.best)
        said: dict[str, Sighting] = {model.name: self._unseen[model.name] for model in models}
        found = [model for model in models if isinstance(watch.best[model.name], Seen)]
        if found:
            said |= self._search(pixels, found)
        if is_over or found:
            self._watch = None
        return said

    def _keep_unseen(self, said: Mapping[str, Sighting]) -> None:
        self._unseen.update({name: one for name, one in said.items() if isinstance(one, Unseen)})

    def _search_one(
        self,
        pixels: Pixels,
        model: MarkerModel,
        candidates: list[Candidate],
    ) -> Sighting:
        best: Sighting = Unseen(reason=UnseenReason.NO_CANDIDATE)
        fits = 0
        for candidate in candidates:
            start = pose_from_corners(self.camera, candidate.corners_px, side_mm=model.side_mm)
            sighting = None if start is None else self._near(pixels, model, start, found_by="search")
            if sighting is None:
                continue
            best = max(best, sighting, key=worth_of)
            fits += 1
            # Candidates come likeliest first: one that leaves nothing open ends the search.
            if fits >= MOST_FITS or worth_of(best) > CERTAIN_WORTH:
                break
        return best
