"""Procedural textures from tileable noise, scaled in mm."""

import cv2
import numpy as np
import numpy.typing as npt

Image32 = npt.NDArray[np.float32]
Coordinates = npt.NDArray[np.floating]
TILE = 256


class Grain:
    """Tileable multi-scale noise, mean 0 and sd about 1."""

    def __init__(self, random: np.random.Generator) -> None:
        white = random.standard_normal((TILE, TILE)).astype(np.float32)
        spectrum = np.fft.rfft2(white)
        fy, fx = np.fft.fftfreq(TILE)[:, None], np.fft.rfftfreq(TILE)[None, :]
        size = np.maximum(np.hypot(fx, fy), 1.0 / TILE)
        # Amplitude over frequency to 1.2: bone, skin and cloth all have about as much on every scale.
        cloudy = np.fft.irfft2(spectrum / size**1.2, s=(TILE, TILE))
        self._cloudy = ((cloudy - cloudy.mean()) / cloudy.std()).astype(np.float32)
        soft = cv2.GaussianBlur(white, (0, 0), 0.6, borderType=cv2.BORDER_REFLECT_101)
        self._white: Image32 = np.asarray(soft, dtype=np.float32)

    def clouds(self, x_mm: Coordinates, y_mm: Coordinates, period_mm: float) -> Image32:
        """Return low-frequency noise with period `period_mm` at coordinates of equal shape (h, w)."""
        return _looked_up(self._cloudy, x_mm, y_mm, TILE / period_mm)

    def specks(self, x_mm: Coordinates, y_mm: Coordinates, speck_mm: float) -> Image32:
        """Return fine specks of this size."""
        return _looked_up(self._white, x_mm, y_mm, 1.0 / speck_mm)


def _looked_up(tile: Image32, x_mm: Coordinates, y_mm: Coordinates, per_mm: float) -> Image32:
    # A wide tile with its first row and column again lets plain bilinear lookup run over the seam.
    wide = np.pad(tile, ((0, 1), (0, 1)), mode="wrap")
    x = np.mod(x_mm * np.float32(per_mm), TILE).astype(np.float32)
    y = np.mod(y_mm * np.float32(per_mm), TILE).astype(np.float32)
    shape = x.shape
    if x.ndim == 1:
        # remap takes no image with more than 32767 rows or columns.
        side = int(np.ceil(np.sqrt(x.size)))
        x, y = (np.pad(v, (0, side * side - v.size)).reshape(side, side) for v in (x, y))
    out = cv2.remap(wide, x, y, cv2.INTER_LINEAR)
    return np.asarray(out, dtype=np.float32).reshape(-1)[: int(np.prod(shape))].reshape(shape)
