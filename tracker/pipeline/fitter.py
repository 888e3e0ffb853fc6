"""From about where a marker could be to what is said of it: gradient, fit, score and judgement."""

from collections.abc import Iterator, Sequence

import numpy as np

from tracker.camera import CameraModel
from tracker.edges import edgels_of, gradient_of
from tracker.geometry import Camera, Marker, Rigid
from tracker.marker import Candidate, MarkerModel, ScoreSettings
from tracker.pose import (
    FoundBy,
    Pixels,
    Scene,
    Sighting,
    corners_px_at,
    judged,
    occurrence_near,
    pose_from_corners,
    window_around,
    with_target,
    worth_of,
)
from tracker.stages import Stages

# Corners of an outline are intersections of fitted lines: off by a pixel, two on a bent sheet.
SEARCH_REACH_PX = 2.5
# A hand in theatre moves the marker by a few pixels from image to image; prediction takes most of it.
TRACK_REACH_PX = 6.0
MAX_FITS, MAX_THOROUGH_FITS = 2, 4
# Seen (2), with score and target score of 0.9 on average.
CERTAIN_WORTH = 3.8


class Fitter:
    """Lays models on the images of one camera.

    Attributes:
        stages: what its stages, and those of a search that it serves, are timed by.
    """

    def __init__(self, *, camera: CameraModel, settings: ScoreSettings, stages: Stages) -> None:
        self._camera, self._settings, self.stages = camera, settings, stages

    def near(
        self, pixels: Pixels, model: MarkerModel, start: Rigid[Camera, Marker], *, found_by: FoundBy
    ) -> Sighting | None:
        """What stands at about this pose; None when it would be outside the image, or nothing fits there."""
        corners = corners_px_at(self._camera, model, start)
        window = window_around(corners, reach_px=TRACK_REACH_PX, size_wh_px=self._camera.size_wh_px)
        if window is None:
            return None
        expected = start if found_by == "track" else None
        left, top, right, bottom = window
        part = np.ascontiguousarray(pixels.image[top:bottom, left:right])
        gradient = gradient_of(part, left_px=left, top_px=top)
        self.stages.end("gradient")
        reach = SEARCH_REACH_PX if expected is None else TRACK_REACH_PX
        found = occurrence_near(self._camera, model, gradient, start, first_reach_px=reach, expected=expected)
        self.stages.end("fit")
        if found is None:
            return None
        found = with_target(self._camera, model, gradient, edgels_of(gradient), found)
        self.stages.end("score")
        scene = Scene(
            camera=self._camera,
            model=model,
            pixels=pixels,
            window=part,
            gradient=gradient,
            settings=self._settings,
            expected=expected,
        )
        sighting = judged(scene, found)
        self.stages.end("judgement")
        return sighting

    def each_of(
        self, pixels: Pixels, model: MarkerModel, candidates: Sequence[Candidate], *, most: int = MAX_FITS
    ) -> Iterator[Sighting]:
        """What some candidates, the likeliest first, turn out to be, one after the other, up to so many."""
        fits = 0
        for candidate in candidates:
            start = pose_from_corners(self._camera, candidate.corners_px, side_mm=model.side_mm)
            sighting = None if start is None else self.near(pixels, model, start, found_by="search")
            if sighting is None:
                continue
            yield sighting
            fits += 1
            if fits >= most:
                break


def is_certain(sighting: Sighting) -> bool:
    """Whether nothing better need be looked for."""
    return worth_of(sighting) > CERTAIN_WORTH
