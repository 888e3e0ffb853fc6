"""Window and level: the HU range that is mapped to grey."""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
import numpy.typing as npt

from tracker.errors import PlanError


@dataclass(frozen=True, slots=True, kw_only=True)
class Window:
    """Grey mapping: centre minus half the width is black, centre plus half the width is white.

    Raises:
        PlanError: WINDOW_INVALID, the width is not above 0, or a number is not finite.
    """

    centre_hu: float
    width_hu: float

    def __post_init__(self) -> None:
        if not (np.isfinite([self.centre_hu, self.width_hu]).all() and self.width_hu > 0.0):
            raise PlanError(
                "WINDOW_INVALID",
                f"a window of {self.width_hu:g} HU around {self.centre_hu:g} HU shows nothing, needed a "
                "width above 0",
                "Set window and level again, or choose one by name.",
                {"width_hu": self.width_hu, "centre_hu": self.centre_hu},
            )


WINDOWS: Mapping[str, Window] = MappingProxyType(
    {
        "bone": Window(centre_hu=400.0, width_hu=1800.0),
        "soft tissue": Window(centre_hu=40.0, width_hu=400.0),
        "metal": Window(centre_hu=1500.0, width_hu=5000.0),
        "whole": Window(centre_hu=500.0, width_hu=3000.0),
    }
)


def shown(hu: npt.NDArray[np.int16], window: Window) -> npt.NDArray[np.uint8]:
    """Map Hounsfield units of any shape to grey, 0 (black) to 255 (white).

    DICOM PS3.3 C.11.2.1.3.2, the exact linear function.
    """
    every = np.arange(-32768, 32768, dtype=np.float64)
    grey = np.rint(np.clip((every - window.centre_hu) / window.width_hu + 0.5, 0.0, 1.0) * 255.0)
    return np.asarray(grey.astype(np.uint8)[hu.astype(np.int32) + 32768])
