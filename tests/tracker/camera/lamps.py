"""Adds mains-powered lamps to an image rendered without them."""

import numpy as np


def lit(
    image: np.ndarray, at_s: float, *, light_hz: float, depth_ratio: float, readout_s: float = 0.0
) -> np.ndarray:
    """The image (h, w, 3) with light that varies while its rows are exposed one after another."""
    row_s = at_s + readout_s * np.arange(len(image)) / len(image)
    gain = 1.0 + depth_ratio * np.cos(2.0 * np.pi * light_hz * row_s + 0.7)
    return np.asarray(np.clip(image * gain[:, None, None] + 0.5, 0.0, 255.0), dtype=np.uint8)
