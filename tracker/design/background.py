"""The images of a background, and what the tracker itself says of a marker in them."""

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
    """What a marker must not be mistaken in.

    Attributes:
        images: grey (h, w), of any sizes.
        places: the squares in them, by the images' indexes.
        camera_of: a camera for a size of image: the tracker needs one to search.
    """

    images: tuple[GreyImage, ...]
    places: Places
    camera_of: CameraOf


@dataclass(frozen=True, slots=True, kw_only=True)
class Claim:
    """A marker that the tracker claims in an image of the background.

    Attributes:
        image_index: of the image.
        corners_px: (4, 2), as in `Seen`.
        score_ratio: its score.
    """

    image_index: int
    corners_px: Array
    score_ratio: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Searched:
    """What `Tracker.search` said of one marker in all images.

    Attributes:
        best_score_ratio: the best score that anything reached, 0 where nothing was scored.
        claims: where it claims the marker, the best score first.
    """

    best_score_ratio: float
    claims: tuple[Claim, ...]


def searched(
    models: Sequence[MarkerModel], background: Background, settings: ScoreSettings, *, advance: Advance
) -> dict[str, Searched]:
    """The tracker's own search for each marker in each image; `advance` is called after each image."""
    best = dict.fromkeys((model.name for model in models), 0.0)
    claims: dict[str, list[Claim]] = {model.name: [] for model in models}
    trackers: dict[tuple[int, int], list[Tracker]] = {}
    for index, image in enumerate(background.images):
        size = (image.shape[1], image.shape[0])
        if size not in trackers:
            camera = background.camera_of(size)
            # One each: several in one tracker would take places from each other.
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
        name: Searched(
            best_score_ratio=best[name],
            claims=tuple(sorted(claims[name], key=lambda claim: claim.score_ratio, reverse=True)),
        )
        for name in best
    }
