"""Text about lamp flicker, with exposure times that avoid it."""

from server.texts.camera_note import CameraNote
from server.texts.language import Language, number_text, text_of
from tracker.camera import LampFlicker

CODE = "LAMP_FLICKER"
DEFAULT_RATE_HZ = 30.0
OR = {"en": " or ", "de": " oder "}


def flicker_note(flicker: LampFlicker, *, exposure_ms: float | None, rate_hz: float) -> CameraNote:
    """Return the note about lamp flicker.

    Args:
        flicker: Detected flicker.
        exposure_ms: Exposure time; None if unknown.
        rate_hz: Images per second; 0 if unknown. It bounds the exposure time.
    """

    def message(language: Language) -> str:
        percent = number_text(100.0 * flicker.depth_ratio, language)
        mains = OR[language].join(f"{mains_hz} Hz" for mains_hz in flicker.mains_hz)
        exposure = "" if exposure_ms is None else number_text(exposure_ms, language)
        if language == "de":
            shown = f"Lampen flackern um {percent} % im Bild ({mains})"
            return f"{shown}, Belichtung {exposure} ms." if exposure else f"{shown}."
        shown = f"Lamps flicker by {percent} % in the image ({mains} mains)"
        return f"{shown}, exposure {exposure} ms." if exposure else f"{shown}."

    def remedy(language: Language) -> str:
        choices = "; ".join(
            f"{OR[language].join(number_text(ms, language) for ms in exposures)} ms ({mains_hz} Hz)"
            for mains_hz in flicker.mains_hz
            if (exposures := even_exposures_ms(mains_hz, exposure_ms=exposure_ms, rate_hz=rate_hz))
        )
        if not choices:
            return (
                "Gleichstromlampen verwenden oder die Bildrate senken."
                if language == "de"
                else "Use direct-current lamps, or a lower image rate."
            )
        return (
            f"Belichtung fest auf {choices} stellen." if language == "de" else f"Set exposure to {choices}."
        )

    return CameraNote(code=CODE, message=text_of(message), remedy=text_of(remedy))


def even_exposures_ms(mains_hz: int, *, exposure_ms: float | None, rate_hz: float) -> list[float]:
    """Return up to two exposure times without flicker: the light's periods nearest to the present exposure.

    Args:
        mains_hz: 50 or 60; the light flickers at twice this frequency.
        exposure_ms: Present exposure time; None if unknown.
        rate_hz: Images per second; 0 if unknown.
    """
    period_ms = 500.0 / mains_hz
    max_periods = int(1000.0 / ((rate_hz or DEFAULT_RATE_HZ) * period_ms) + 1e-6)
    wanted = period_ms if exposure_ms is None else exposure_ms
    # The present exposure is not proposed again.
    periods = [n for n in range(1, max_periods + 1) if abs(n * period_ms - (exposure_ms or 0.0)) > 0.1]
    nearest = sorted(periods, key=lambda n: abs(n * period_ms - wanted))[:2]
    return [n * period_ms for n in sorted(nearest)]
