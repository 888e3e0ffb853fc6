"""A flickering lamp in words, with the exposures that would even it out."""

from dataclasses import dataclass

from server.shown import shown_number
from server.texts.language import Language, Text, text_of
from tracker.camera import LampFlicker

CODE = "LAMP_FLICKER"
DEFAULT_RATE_HZ = 30.0
OR = {"en": " or ", "de": " oder "}


@dataclass(frozen=True, slots=True, kw_only=True)
class CameraNote:
    """Something about the camera that is worth mending, and stops nothing.

    Attributes:
        code: which it is.
        message: what was found, in numbers.
        remedy: what to do.
    """

    code: str
    message: Text
    remedy: Text


def flicker_note(flicker: LampFlicker, *, exposure_ms: float | None, rate_hz: float) -> CameraNote:
    """The note about a flickering lamp.

    Args:
        flicker: what was found.
        exposure_ms: of the images; None where it is not known.
        rate_hz: images a second; 0 where it is not known. No exposure is longer than from image to image.
    """

    def message(language: Language) -> str:
        percent = shown_number(100.0 * flicker.depth_ratio, decimals=1)
        mains = OR[language].join(f"{mains_hz} Hz" for mains_hz in flicker.mains_hz)
        exposure = "" if exposure_ms is None else shown_number(exposure_ms, decimals=1)
        if language == "de":
            shown = f"Lampen flackern um {percent} % im Bild ({mains})"
            return f"{shown}, Belichtung {exposure} ms." if exposure else f"{shown}."
        shown = f"Lamps flicker by {percent} % in the image ({mains} mains)"
        return f"{shown}, exposure {exposure} ms." if exposure else f"{shown}."

    def remedy(language: Language) -> str:
        choices = "; ".join(
            f"{OR[language].join(shown_number(ms, decimals=1) for ms in exposures)} ms ({mains_hz} Hz)"
            for mains_hz in flicker.mains_hz
            if (exposures := even_exposures_ms(mains_hz, exposure_ms=exposure_ms, rate_hz=rate_hz))
        )
        if not choices:
            return (
                "Lampen mit Gleichstrom verwenden oder die Bildrate senken."
                if language == "de"
                else "Use lamps on direct current, or a lower image rate."
            )
        return (
            f"Belichtung fest auf {choices} stellen." if language == "de" else f"Set exposure to {choices}."
        )

    return CameraNote(code=CODE, message=text_of(message), remedy=text_of(remedy))


def even_exposures_ms(mains_hz: int, *, exposure_ms: float | None, rate_hz: float) -> list[float]:
    """One or two exposures over which this mains' light is even: whole periods of it, nearest to the present.

    Args:
        mains_hz: 50 or 60; light has twice that.
        exposure_ms: at present; None where it is not known.
        rate_hz: images a second; 0 where it is not known.
    """
    period_ms = 500.0 / mains_hz
    most = int(1000.0 / ((rate_hz or DEFAULT_RATE_HZ) * period_ms) + 1e-6)
    wanted = period_ms if exposure_ms is None else exposure_ms
    # One of them that is the present one again is no remedy.
    periods = [n for n in range(1, most + 1) if abs(n * period_ms - (exposure_ms or 0.0)) > 0.1]
    nearest = sorted(periods, key=lambda n: abs(n * period_ms - wanted))[:2]
    return [n * period_ms for n in sorted(nearest)]
