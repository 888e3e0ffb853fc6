"""Texts about flickering lamps, and the proposed exposures."""

import pytest

from server.number_format import format_number
from server.texts import flicker_note
from server.texts.flicker import even_exposures_ms
from tracker.camera import LampFlicker


@pytest.mark.parametrize(
    ("mains_hz", "exposure_ms", "rate_hz", "exposures_ms"),
    [
        (50, 7.0, 30.0, ["10.0", "20.0"]),
        (50, 27.0, 30.0, ["20.0", "30.0"]),
        (60, 7.0, 30.0, ["8.3", "16.7"]),
        (60, None, 30.0, ["8.3", "16.7"]),
        # Not longer than the interval of images.
        (50, 7.0, 60.0, ["10.0"]),
        (60, 4.0, 100.0, ["8.3"]),
        (50, 4.0, 120.0, []),
        # The present exposure is not proposed.
        (50, 10.0, 30.0, ["20.0", "30.0"]),
    ],
)
def test_exposures_are_whole_periods_of_the_light(
    mains_hz: int, exposure_ms: float | None, rate_hz: float, exposures_ms: list[str]
) -> None:
    found = even_exposures_ms(mains_hz, exposure_ms=exposure_ms, rate_hz=rate_hz)
    assert [format_number(ms, decimals=1) for ms in found] == exposures_ms


def test_the_note_has_mains_depth_exposure_and_remedy_in_both_languages() -> None:
    note = flicker_note(LampFlicker(mains_hz=(50,), depth_ratio=0.124), exposure_ms=7.0, rate_hz=30.0)
    assert note.message == {
        "en": "Lamps flicker by 12.4 % in the image (50 Hz mains), exposure 7.0 ms.",
        "de": "Lampen flackern um 12,4 % im Bild (50 Hz), Belichtung 7,0 ms.",
    }
    assert note.remedy == {
        "en": "Set exposure to 10.0 or 20.0 ms (50 Hz).",
        "de": "Belichtung fest auf 10,0 oder 20,0 ms (50 Hz) stellen.",
    }


def test_unknown_mains_or_exposure_are_stated_in_the_note() -> None:
    note = flicker_note(LampFlicker(mains_hz=(50, 60), depth_ratio=0.05), exposure_ms=None, rate_hz=0.0)
    assert note.message["en"] == "Lamps flicker by 5.0 % in the image (50 Hz or 60 Hz mains)."
    assert note.remedy["en"] == "Set exposure to 10.0 or 20.0 ms (50 Hz); 8.3 or 16.7 ms (60 Hz)."
    fast = flicker_note(LampFlicker(mains_hz=(50,), depth_ratio=0.05), exposure_ms=2.0, rate_hz=200.0)
    assert fast.remedy["en"] == "Use direct-current lamps, or a lower image rate."
