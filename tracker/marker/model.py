"""The marker that is searched for: any printed square shape, known by its edges."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt


@dataclass(frozen=True, slots=True, kw_only=True)
class MarkerModel:
    """A printed square with a unique geometric shape."""

    name: str
    side_mm: float
    image: npt.NDArray[np.uint8]

    @classmethod
    def from_image(cls, image: npt.NDArray[np.uint8], *, side_mm: float, name: str) -> "MarkerModel":
        """From a grey image (h, w) which the black square fills edge to edge, row 0 on top."""
        return cls(name=name, side_mm=float(side_mm), image=np.array(image, dtype=np.uint8))
