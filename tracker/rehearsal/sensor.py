"""From light to 8 bit: how lens, exposure, lamp and sensor spoil the picture."""

import cv2
import numpy as np
import numpy.typing as npt

from tracker.geometry import Array
from tracker.rehearsal.settings import TheatreSettings

Image8 = npt.NDArray[np.uint8]
Image32 = npt.NDArray[np.float32]

DEFOCUS_PX, EXPOSURE_S, LONGEST_EXPOSURE_S = 0.6, 0.008, 0.033
READ_NOISE, SHOT_NOISE_PER_LEVEL = 0.6, 0.012
BANK_MARGIN = 256
BANK_SCALE, SIGMA_SCALE = 64, 16
FLICKER_HZ = (0.17, 0.41)


class Sensor:
    """Gain, gradient and flicker of the light, and the sensor's noise, as the settings have them."""

    def __init__(self, settings: TheatreSettings) -> None:
        random = np.random.default_rng([settings.seed, 0x53454E53])
        width, height = settings.size_wh_px
        self.settings = settings
        self._flicker_rad = random.uniform(0.0, 2.0 * np.pi, 2)
        self.gain = _gain(settings, random)
        bank = random.standard_normal((height + BANK_MARGIN, width + BANK_MARGIN, 3), dtype=np.float32)
        self._bank = np.rint(bank * BANK_SCALE).astype(np.int16)
        levels = np.arange(256)
        sigma = settings.noise * np.sqrt(READ_NOISE**2 + SHOT_NOISE_PER_LEVEL * levels)
        self._sigma_of_level = np.rint(sigma * SIGMA_SCALE).astype(np.int16)

    def sigmas(self, picture: Image8) -> npt.NDArray[np.int16]:
        """The noise's deviation of each value, in 1/16 levels."""
        return np.take(self._sigma_of_level, picture)

    def read_out(self, picture: Image8, sigmas: npt.NDArray[np.int16], at_s: float) -> Image8:
        """The picture as the sensor gives it at this time: flicker, then noise, then 8 bit."""
        lit = self._flickered(picture, at_s)
        if self.settings.noise == 0.0:
            return lit
        stamp = round(at_s * 1e6) % 2**63
        row, column = np.random.default_rng([self.settings.seed, stamp]).integers(0, BANK_MARGIN, 2)
        height, width = picture.shape[:2]
        grains = self._bank[row : row + height, column : column + width]
        noise = cv2.multiply(sigmas, grains, scale=1.0 / (BANK_SCALE * SIGMA_SCALE))
        return np.asarray(cv2.add(lit, noise, dtype=cv2.CV_8U), dtype=np.uint8)

    def _flickered(self, picture: Image8, at_s: float) -> Image8:
        if self.settings.light == 0.0:
            return picture
        waves = np.sin(2.0 * np.pi * np.array(FLICKER_HZ) * at_s + self._flicker_rad)
        gain = 1.0 + 0.008 * self.settings.light * float(waves.mean())
        table = np.clip(np.rint(np.arange(256) * gain), 0, 255).astype(np.uint8)
        return np.asarray(cv2.LUT(picture, table), dtype=np.uint8)


def _gain(settings: TheatreSettings, random: np.random.Generator) -> Image32:
    """How bright the light is over the image (h, w): dimmer and more lopsided the harder it is."""
    width, height = settings.size_wh_px
    x = np.linspace(-1.0, 1.0, width, dtype=np.float32)[None, :]
    y = np.linspace(-1.0, 1.0, height, dtype=np.float32)[:, None]
    angle = random.uniform(0.0, 2.0 * np.pi)
    slope = np.cos(angle) * x + 0.6 * np.sin(angle) * y
    light = settings.light
    gain = (1.0 - 0.045 * light) * (1.0 + 0.055 * light * slope - 0.02 * light * (x * x + 0.5 * y * y))
    return np.asarray(np.clip(gain, 0.03, 1.6), dtype=np.float32)


def spread_kernel(blur: float, speed_px_s: Array) -> Image32 | None:
    """What defocus and motion during the exposure make of a point; None if it stays one.

    Defocus is a Gaussian; the motion is a straight line, even in time, centred on the middle of the exposure,
    so that the picture shows where things are at its own time.
    """
    sigma = DEFOCUS_PX * blur
    exposure = min(EXPOSURE_S * blur, LONGEST_EXPOSURE_S)
    path = np.asarray(speed_px_s, dtype=np.float64) * exposure
    length = float(np.linalg.norm(path))
    if sigma < 0.05 and length < 0.05:
        return None
    steps = np.linspace(-0.5, 0.5, max(1, int(np.ceil(length * 4.0))) + 1)[:, None] * path
    reach = int(np.ceil(3.0 * sigma + length / 2.0)) + 1
    at = np.arange(-reach, reach + 1)
    along_x = np.exp(-0.5 * ((at[None, :] - steps[:, :1]) / sigma) ** 2)
    along_y = np.exp(-0.5 * ((at[None, :] - steps[:, 1:]) / sigma) ** 2)
    kernel = along_y.T @ along_x
    return np.asarray(kernel / kernel.sum(), dtype=np.float32)
