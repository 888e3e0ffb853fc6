"""The stages of the tracker in order, and nothing else."""

from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

from tracker.camera import CameraModel
from tracker.marker import MarkerModel
from tracker.pose import Sighting, Unseen, UnseenReason


class Tracker:
    """Finds any number of markers in images of one camera."""

    def __init__(self, *, camera: CameraModel, models: Sequence[MarkerModel]) -> None:
        self.camera = camera
        self.models = tuple(models)
        self.stage_ms: Mapping[str, float] = {}

    def step(self, image: npt.NDArray[np.uint8], *, captured_at_s: float) -> dict[str, Sighting]:
        """What this image says of each marker, using what is known from the images before it."""
        del captured_at_s
        return self.search(image)

    def search(self, image: npt.NDArray[np.uint8]) -> dict[str, Sighting]:
        """What this image says of each marker: the whole image, no prior, stateless."""
        del image
        return {model.name: Unseen(reason=UnseenReason.NO_CANDIDATE) for model in self.models}
