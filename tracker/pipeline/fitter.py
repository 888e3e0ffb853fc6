"""From an approximate pose of a marker to a sighting: gradient, fit, score and verification."""

from collections.abc import Iterator, Sequence

import numpy as np

from tracker.camera import CameraModel
from tracker.edges import edgels_of, gradient_of
from tracker.geometry import Camera, Marker, Rigid
from tracker.marker import Candidate, MarkerModel, ScoreSettings
from tracker.pose import (
    FoundBy,
    ImageContext,
    OccurrenceContext,
    Sighting,
    corners_px_at,
    occurrence_near,
    pose_from_corners,
    rank_score,
    verify_occurrence,
    window_around,
    with_target_coverage,
)
from tracker.stage_timer import StageTimer

# Corners of a quadrilateral are intersections of fitted lines, with errors of one pixel, two on bent paper.
SEARCH_REACH_PX = 2.5
# A hand in theatre moves the marker by a few pixels between images; prediction removes most of it.
TRACK_REACH_PX = 6.0
MAX_FITS, MAX_THOROUGH_FITS = 2, 4
# Seen (2), with score and target score of 0.9 on average.
CERTAIN_RANK_SCORE = 3.8


class Fitter:
    """Fits marker models to the images of one camera.

    Attributes:
        stages: timer of the stages of this fitter and of a search that uses it.
    """

    def __init__(self, *, camera: CameraModel, settings: ScoreSettings, stages: StageTimer) -> None:
        self._camera, self._settings, self.stages = camera, settings, stages

    def near(
        self, pixels: ImageContext, model: MarkerModel, start: Rigid[Camera, Marker], *, found_by: FoundBy
    ) -> Sighting | None:
        """Return the sighting near this pose; None when it is outside the image, or nothing fits there."""
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
        found = with_target_coverage(self._camera, model, gradient, edgels_of(gradient), found)
        self.stages.end("score")
        scene = OccurrenceContext(
            camera=self._camera,
            model=model,
            pixels=pixels,
            window=part,
            gradient=gradient,
            settings=self._settings,
            expected=expected,
        )
        sighting = verify_occurrence(scene, found)
        self.stages.end("judgement")
        return sighting

    def fit_candidates(
        self,
        pixels: ImageContext,
        model: MarkerModel,
        candidates: Sequence[Candidate],
        *,
        maximum: int = MAX_FITS,
    ) -> Iterator[Sighting]:
        """Yield the sightings of candidates, the most probable first, up to `most` fits."""
        fits = 0
        for candidate in candidates:
            start = pose_from_corners(self._camera, candidate.corners_px, side_mm=model.side_mm)
            sighting = None if start is None else self.near(pixels, model, start, found_by="search")
            if sighting is None:
                continue
            yield sighting
            fits += 1
            if fits >= maximum:
                break


def is_certain(sighting: Sighting) -> bool:
    """Return whether the search can stop at this sighting."""
    return rank_score(sighting) > CERTAIN_RANK_SCORE
