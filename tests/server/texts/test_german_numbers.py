"""German sentences have decimal commas: the catalogue, and all texts of a drilling."""

import re
from string import Formatter

import pytest
from pydantic import BaseModel

from server.overlay import panel_of
from server.texts import error_reason
from server.texts.camera_note import PREDICTED_VIDEO
from server.texts.errors.catalogue import MESSAGES, REMEDIES
from server.texts.errors.phrases import PHRASES
from server.texts.flicker import flicker_note
from server.texts.language import fill, number_text
from server.texts.steps import REASONS
from tests.server.texts.random_drilling import RandomDrilling
from tracker.camera import LampFlicker

DECIMAL_POINT = re.compile(r"\d\.\d")
TEMPLATES = [
    *((code, text["de"]) for code, texts in MESSAGES.items() for text in texts),
    *((code, one.message["de"]) for code, one in REASONS.items()),
    *((code, one.remedy["de"]) for code, one in REASONS.items()),
    *(("remedy", text["de"]) for text in REMEDIES),
    *((name, text["de"]) for name, texts in PHRASES.items() for text in texts),
]
# What a person types into a terminal.
OPTIONS = re.compile(r"--[\w-]+ [\d.]+")


def values_of(template: str) -> dict[str, object]:
    """Return 1.25 for each value of a template, as a number or as a list of numbers."""
    values: dict[str, object] = {}
    for _, name, _, _ in Formatter().parse(template):
        if name:
            values[re.split(r"[\[.]", name)[0]] = [1.25] * 8 if "[" in name else 1.25
    return values


def test_no_template_of_the_catalogue_writes_a_decimal_point() -> None:
    with_decimals = 0
    for code, template in TEMPLATES:
        # Counts and dates are given as numbers here.
        counts = re.sub(r":%[^}]*\}|:d\}", "}", template)
        written = fill(counts, values_of(counts), "de")
        assert not DECIMAL_POINT.search(OPTIONS.sub("", written)), (code, written)
        with_decimals += "1,2" in written
    assert with_decimals > 200


def test_all_german_texts_of_a_drilling_have_commas() -> None:
    commas = 0
    for moment in RandomDrilling(1).moments(300):
        for text in [*german_texts(moment.message), *german_texts_of_lines(list(moment.lines))]:
            assert not DECIMAL_POINT.search(text), text
            commas += "," in text
        if moment.snapshot is not None:
            panel = panel_of(moment.snapshot, moment.alarms, "de")
            drawn = [(one.value, one.hint) for one in panel.readings]
            assert not DECIMAL_POINT.search(str(drawn)), drawn
    assert commas > 100


def german_texts(message: object) -> list[str]:
    """Return all German texts of a message of the wire."""
    if isinstance(message, BaseModel):
        return german_texts({name: getattr(message, name) for name in type(message).model_fields})
    if isinstance(message, dict):
        if message.keys() == {"en", "de"}:
            return [str(message["de"])]
        return [text for value in message.values() for text in german_texts(value)]
    return [text for one in message for text in german_texts(one)] if isinstance(message, list) else []


def german_texts_of_lines(lines: list[object]) -> list[str]:
    """Return all German texts of lines of the alarm log."""
    return [text for line in lines for text in german_texts(line)]


def test_notes_about_the_camera_have_commas() -> None:
    note = flicker_note(LampFlicker(depth_ratio=0.1234, mains_hz=(50, 60)), exposure_ms=7.0, rate_hz=30.0)
    for text in (note.message["de"], note.remedy["de"], PREDICTED_VIDEO.message["de"]):
        assert "," in text
        assert not DECIMAL_POINT.search(text), text


@pytest.mark.parametrize(
    ("value", "german"),
    [
        pytest.param(0.8, "0,8", id="a number"),
        pytest.param("0.45 x 0.45 x 0.60", "0,45 x 0,45 x 0,60", id="a size"),
        pytest.param("3.5, 4, 4.5", "3,5; 4; 4,5", id="a list, of which commas would be decimal signs"),
        pytest.param("192.168.0.1", "192.168.0.1", id="an address"),
        pytest.param("1.2.840.10008.1.2", "1.2.840.10008.1.2", id="a UID"),
        pytest.param("scan 1.5 mm.nii", "scan 1.5 mm.nii", id="the name of a file"),
        pytest.param("0.1.0", "0.1.0", id="a version"),
        pytest.param("camera.rate_hz", "camera.rate_hz", id="a setting"),
    ],
)
def test_only_numbers_get_a_comma(value: object, german: str) -> None:
    assert fill("{value}", {"value": value}, "de") == german
    assert fill("{value}", {"value": value}, "en") == str(value)


def test_an_error_keeps_its_english_numbers() -> None:
    message = "the tip's uncertainty is 1.2 mm in the worst image, allowed 0.5 mm"
    remedy = "Hold the marker nearer to the camera and in better light, and touch the landmark again."
    why = error_reason("CAPTURE_UNCERTAIN", message, remedy, {"tip_sd_mm": 1.2, "allowed_mm": 0.5})
    assert why.message["de"].endswith("1,2 mm, erlaubt 0,5 mm")
    assert why.message["en"] == message
    assert number_text(-0.04, "de") == "0,0"
