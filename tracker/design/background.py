"""Background images, and the tracker's own detections of a marker in them."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from tracker.camera import CameraModel
from tracker.design.places import Places
from tracker.edges import GreyImage
from tracker.geometry import Array
from tracker.marker import MarkerModel, ScoreSettings
from tracker.pipeline import Tracker
from tracker.pose import Seen

CameraOf: TypeAlias = Callable[[tuple[int, int]], CameraModel]
Advance: TypeAlias = Callable[[], None]


@dataclass(frozen=True, slots=True, kw_only=True)
class Background:
    """Images in which a marker must not be detected.

    Attributes:
        images: grey (h, w), of any size.
        places: their square candidates, by image index.
        camera_of: returns a camera for an image size; the tracker needs one to search.
    """

    images: tuple[GreyImage, ...]
    places: Places
    camera_of: CameraOf


@dataclass(frozen=True, slots=True, kw_only=True)
class Claim:
    """A detection of the marker in a background image: a false positive.

    Attributes:
        image_index: of the image.
        corners_px: (4, 2), as in `Seen`.
        score_ratio: its score.
    """

    image_index: int
    corners_px: Array
    score_ratio: float


@dataclass(frozen=True, slots=True, kw_only=True)
class SearchResult:
    """Result of `Tracker.search` for one marker over all background images.

    Attributes:
        best_score_ratio: the maximum score of any candidate, 0 without one.
        claims: false detections, best score first.
    """

    best_score_ratio: float
    claims: tuple[Claim, ...]


def search_background(
    models: Sequence[MarkerModel], background: Background, settings: ScoreSettings, *, advance: Advance
) -> dict[str, SearchResult]:
    """Search each image for each marker with the tracker itself; call `advance` after each image."""
    best = dict.fromkeys((model.name for model in models), 0.0)
    claims: dict[str, list[Claim]] = {model.name: [] for model in models}
    trackers: dict[tuple[int, int], list[Tracker]] = {}
    for index, image in enumerate(background.images):
        size = (image.shape[1], image.shape[0])
        if size not in trackers:
            camera = background.camera_of(size)
            # One tracker per model: in a common tracker, models compete for candidates.
            trackers[size] = [Tracker(camera=camera, models=[model], settings=settings) for model in models]
        for tracker in trackers[size]:
            for name, sighting in tracker.search(image).items():
                if isinstance(sighting, Seen):
                    claim = Claim(
                        image_index=index, corners_px=sighting.corners_px, score_ratio=sighting.score_ratio
                    )
                    claims[name].append(claim)
                    best[name] = max(best[name], sighting.score_ratio)
                else:
                    best[name] = max(best[name], sighting.best_score_ratio or 0.0)
        advance()
    return {
        name: SearchResult(
            best_score_ratio=best[name],
            claims=tuple(sorted(claims[name], key=lambda claim: claim.score_ratio, reverse=True)),
        )
        for name in best
    }
