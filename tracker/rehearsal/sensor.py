"""Sensor model: illumination gain, flicker, noise and quantisation to 8 bit."""

import cv2
import numpy as np
import numpy.typing as npt

from tracker.rehearsal.lens import Pixels
from tracker.rehearsal.settings import TheatreSettings

Image8 = npt.NDArray[np.uint8]
Image16 = npt.NDArray[np.int16]
Image32 = npt.NDArray[np.float32]

READ_NOISE, SHOT_NOISE_PER_LEVEL = 0.6, 0.012
BANK_MARGIN = 256
BANK_SCALE, SIGMA_SCALE = 64, 16
NOISE_SCALE = 1.0 / (BANK_SCALE * SIGMA_SCALE)
FLICKER_HZ, FLICKER_RATIO = (0.17, 0.41), 0.008
# Half a grey level at full scale: below this flicker step the static scenery is reused.
FLICKER_STEP = 1.0 / 512.0
# The noise of the static scenery is generated once and shifted by up to this much between images.
STILL_SHIFT_PX = 8


class Sensor:
    """Gain, gradient and flicker of the illumination, and sensor noise, by the settings.

    Attributes:
        gain: (h, w) of the illumination.
        is_noisy: whether there is any noise.
    """

    def __init__(self, settings: TheatreSettings) -> None:
        random = np.random.default_rng([settings.seed, 0x53454E53])
        width, height = settings.size_wh_px
        self._settings = settings
        self._flicker_rad = random.uniform(0.0, 2.0 * np.pi, 2)
        self.gain = _gain(settings, random)
        self.is_noisy = settings.noise > 0.0
        size = (height + BANK_MARGIN, width + BANK_MARGIN, 3)
        bank = random.standard_normal(size, dtype=np.float32)
        self._bank = np.rint(bank * BANK_SCALE).astype(np.int16)
        levels = np.arange(256)
        sigma = settings.noise * np.sqrt(READ_NOISE**2 + SHOT_NOISE_PER_LEVEL * levels)
        self._sigma_of_level = np.rint(sigma * SIGMA_SCALE).astype(np.int16)

    def random_at(self, at_s: float) -> np.random.Generator:
        """Return the random generator of the image at this time."""
        return np.random.default_rng([self._settings.seed, round(at_s * 1e6) % 2**63])

    def flicker_at(self, at_s: float) -> float:
        """Return the illumination gain at this time."""
        if self._settings.light == 0.0:
            return 1.0
        waves = np.sin(2.0 * np.pi * np.array(FLICKER_HZ) * at_s + self._flicker_rad)
        gain = 1.0 + FLICKER_RATIO * self._settings.light * float(waves.mean())
        return round(gain / FLICKER_STEP) * FLICKER_STEP

    def noise(self, levels: Pixels, row: int, column: int) -> Image16:
        """Return noise (h, w, 3) for grey (h, w) or BGR (h, w, 3), from this position of the noise bank."""
        sigmas = cv2.LUT(levels, self._sigma_of_level)
        if levels.ndim == 2:
            sigmas = cv2.merge([sigmas] * 3)
        height, width = levels.shape[:2]
        grains = self._bank[row : row + height, column : column + width]
        return np.asarray(cv2.multiply(sigmas, grains, scale=NOISE_SCALE), dtype=np.int16)

    def noise_table(self, row: int, column: int) -> tuple[Image16, Image16, float]:
        """Return the noise of an image that starts at this position of the noise bank.

        Returns:
            Standard deviation of each grey level (256,), noise of standard deviation 1 (h, w, 3), and the
            scale of their product.
        """
        return self._sigma_of_level, self._bank[row:, column:], NOISE_SCALE

    def still_noise(self, picture: Image8) -> Image8:
        """Return noise (h + 8, w + 8, 3) for this picture (h, w, 3), valid within its margin.

        The picture and this noise, both 8 bit, are added modulo 256 (negative values plus 256), which takes a
        tenth of the time of noise generated for the picture's levels. No sum leaves 0..255 under any
        illumination.
        """
        half = STILL_SHIFT_PX // 2
        wide = cv2.copyMakeBorder(picture, half, half, half, half, cv2.BORDER_REPLICATE)
        around = np.ones((STILL_SHIFT_PX + 1, STILL_SHIFT_PX + 1), dtype=np.uint8)
        change = FLICKER_RATIO * self._settings.light + FLICKER_STEP
        darkest = np.floor(cv2.erode(wide, around) * np.float32(1.0 - change)).astype(np.int16)
        brightest = np.ceil(cv2.dilate(wide, around) * np.float32(1.0 + change)).astype(np.int16)
        noise = np.clip(self.noise(wide, 0, 0), -darkest, 255 - np.minimum(brightest, 255))
        return noise.astype(np.uint8)


def _gain(settings: TheatreSettings, random: np.random.Generator) -> Image32:
    """Return the illumination gain (h, w): dimmer and more uneven with difficulty."""
    width, height = settings.size_wh_px
    x = np.linspace(-1.0, 1.0, width, dtype=np.float32)[None, :]
    y = np.linspace(-1.0, 1.0, height, dtype=np.float32)[:, None]
    angle = random.uniform(0.0, 2.0 * np.pi)
    slope = np.cos(angle) * x + 0.6 * np.sin(angle) * y
    light = settings.light
    gain = (1.0 - 0.045 * light) * (1.0 + 0.055 * light * slope - 0.02 * light * (x * x + 0.5 * y * y))
    return np.asarray(np.clip(gain, 0.03, 1.6), dtype=np.float32)
