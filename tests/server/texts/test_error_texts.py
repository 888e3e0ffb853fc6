"""Translations of errors: the same values in each language, and only for the message that was raised."""

import re
from string import Formatter

import pytest

from server.texts import error_reason, reason_of_error
from server.texts.errors.catalogue import MESSAGES, REMEDIES
from server.texts.errors.phrases import AREAS, PHRASES
from server.texts.errors.phrases.system import SYSTEM_ERRORS
from server.texts.steps import REASONS
from tests.server.texts.error_sites import error_sites, shape_of
from tests.server.texts.phrase_sites import given_phrases, listed_shapes, texts_in_code
from tracker.errors import RegistrationError

TEMPLATES = [
    *((code, text) for code, texts in MESSAGES.items() for text in texts),
    *((code, sentence.message) for code, sentence in REASONS.items()),
    *(("remedy", text) for text in REMEDIES),
    *((name, text) for name, texts in PHRASES.items() for text in texts),
]
MOVED = (
    "the tip moved: it spreads by 0.52 mm (standard deviation, allowed 0.3) "
    "and by 1.20 mm at most (allowed 1)"
)
# Phrases that the code composes of parts.
JOINED = {"cut_ends", "faults", "may", "misfit", "pixel_count", "uncovered_corners"}


def fields(template: str) -> list[tuple[str, str, str]]:
    """Name, format and conversion of each value; equal ones give equal digits."""
    parsed = Formatter().parse(template)
    return sorted((name, spec or "", conversion or "") for _, name, spec, conversion in parsed if name)


def names_of(template: str) -> set[str]:
    """Names of the values in `context` that a template is filled with."""
    return {name.partition("[")[0].partition(".")[0] for name, _, _ in fields(template)}


def test_each_text_is_in_both_languages_with_the_same_values() -> None:
    assert not [code for code, text in TEMPLATES if text.keys() != {"en", "de"}]
    assert not [code for code, text in TEMPLATES if not all(text.values()) and code not in PHRASES]
    assert not [code for code, text in TEMPLATES if fields(text["en"]) != fields(text["de"])]


def test_german_has_words_of_its_own_where_english_has() -> None:
    def has_words(sentence: str) -> bool:
        return bool(re.sub(r"{[^}]*}", "", sentence).strip())

    assert not [code for code, text in TEMPLATES if has_words(text["en"]) != has_words(text["de"])]


def test_german_does_not_address_the_reader() -> None:
    # At the start of a sentence "Sie" and "Ihr" may be a thing's pronoun; elsewhere they are the reader's.
    address = re.compile(r"[\w,;:] (Sie|Ihr(e[mnrs]?)?|Ihnen)\b")
    assert not [(code, text["de"]) for code, text in TEMPLATES if address.search(text["de"])]


def test_no_english_template_is_listed_twice() -> None:
    remedies = [text["en"] for text in REMEDIES]
    for english in ([text["en"] for text in texts] for texts in MESSAGES.values()):
        assert len(english) == len(set(english)), english
    german = {one: {text["de"] for text in REMEDIES if text["en"] == one} for one in remedies}
    assert all(len(one) == 1 for one in german.values())


def test_no_name_of_a_phrase_is_in_two_areas() -> None:
    assert len(PHRASES) == sum(map(len, AREAS))


def test_each_error_that_a_page_can_show_has_german() -> None:
    messages = {code: {shape_of(text["en"]) for text in texts} for code, texts in MESSAGES.items()}
    remedies = {shape_of(text["en"]) for text in REMEDIES}
    sites = error_sites()
    assert len({one.code for one in sites}) > 400, "the test finds no errors"
    lacking = [
        (one.where, one.code, part)
        for one in sites
        for part, is_listed in (
            ("message", one.message in messages.get(one.code, ())),
            ("remedy", not one.remedy or one.remedy in remedies),
        )
        if not is_listed
    ]
    assert not lacking, (
        "write the message by its code into a module of server/texts/errors, and the remedy into the module "
        f"of the same name in server/texts/errors/remedies, in English as raised and in German: {lacking}"
    )


def test_each_translation_is_of_a_message_that_is_raised() -> None:
    raised: dict[str, set[str | None]] = {}
    for one in error_sites():
        raised.setdefault(one.code, set()).add(one.message)
    steps = {sentence.message["en"] for sentence in REASONS.values()}
    stale = [
        (code, text["en"])
        for code, texts in MESSAGES.items()
        for text in texts
        if text["en"] not in steps and shape_of(text["en"]) not in raised.get(code, ())
    ]
    assert not stale, f"reword or delete in server/texts/errors, as nothing raises this any more: {stale}"


def test_each_error_with_a_translation_gives_the_values_of_its_template() -> None:
    lacking = []
    for one in error_sites():
        if one.names is None:
            continue
        message = [text["en"] for text in MESSAGES.get(one.code, ()) if shape_of(text["en"]) == one.message]
        remedy = [text["en"] for text in REMEDIES if shape_of(text["en"]) == one.remedy]
        lacking += [
            (one.where, one.code, texts)
            for texts in (message, remedy)
            if texts and not any(names_of(text) <= one.names for text in texts)
        ]
    assert not lacking, f"the context of the error lacks a value that its template names: {lacking}"


def test_each_phrase_that_is_given_has_a_template() -> None:
    given = list(given_phrases())
    assert len({name for _, name, _ in given}) > 20, "the test finds no phrases"
    lacking = [one for one in given if one[2] and one[2] not in listed_shapes(one[1])]
    assert not lacking, (
        f"write each phrase under its name into a module of server/texts/errors/phrases: {lacking}"
    )


def test_each_template_of_a_phrase_is_used() -> None:
    code = texts_in_code()
    assert not [
        (name, text["en"])
        for name, texts in PHRASES.items()
        for text in texts
        if name not in JOINED
        and text not in SYSTEM_ERRORS
        and any(part not in code for part, *_ in Formatter().parse(text["en"]) if len(part) > 3)
    ]


def test_values_of_a_phrase_are_read_from_its_text() -> None:
    where = "at 41.2 deg from its axis, inside of the image"
    fault = f"its distortion stretches the image 7.31 times, allowed 5, {where}"
    remedy = "Calibrate the camera again, or give OpenCV's K (3x3), distortion and image size."
    message = f"the camera model cannot be used: {fault}"
    why = error_reason("CAMERA_MODEL_INVALID", message, remedy, {"camera_problem": fault})
    assert why.message["en"] == message
    assert why.message["de"] == (
        "das Kameramodell ist nicht verwendbar: seine Verzeichnung streckt das Bild 7,31-fach, erlaubt 5, "
        "41,2° von seiner Achse, innerhalb des Bildes"
    )


@pytest.mark.parametrize(
    "fault",
    [
        pytest.param("its distortion is odd, at 4 deg from its axis", id="of another form"),
        pytest.param("{camera_problem}", id="that is a template"),
        pytest.param(f"its sensor tilts by {'9' * 1000} deg, allowed 45 deg", id="that is very long"),
    ],
)
def test_an_error_with_an_unknown_phrase_stays_english(fault: str) -> None:
    remedy = "Calibrate the camera again, or give OpenCV's K (3x3), distortion and image size."
    message = f"the camera model cannot be used: {fault}"
    why = error_reason("CAMERA_MODEL_INVALID", message, remedy, {"camera_problem": fault, "value": 3})
    assert not why.is_translated
    assert why.message["de"] == message


def test_a_german_error_has_the_numbers_of_the_english_one() -> None:
    values = {"spread_mm": 0.52, "max_off_mm": 1.2, "allowed_mm": 0.3, "allowed_off_mm": 1.0}
    remedy = "Rest the hand, hold the tip still on the landmark, and touch it again."
    why = reason_of_error(RegistrationError("CAPTURE_MOVED", MOVED, remedy, values))
    assert why.is_translated
    assert (why.message["en"], why.remedy["en"]) == (MOVED, remedy)
    assert why.message["de"].startswith("die Spitze bewegte sich: sie streut um 0,52 mm")
    assert why.remedy["de"].startswith("Die Hand auflegen")


@pytest.mark.parametrize(
    ("message", "values"),
    [
        pytest.param(MOVED.replace("0.52", "0.53"), {"spread_mm": 0.52}, id="of other numbers"),
        pytest.param(MOVED, {}, id="without its values"),
        pytest.param(MOVED, {"spread_mm": "0.52"}, id="with values of another type"),
        pytest.param(f"{MOVED} again", {"spread_mm": 0.52}, id="that was reworded"),
    ],
)
def test_an_error_that_differs_from_its_template_stays_english(
    message: str, values: dict[str, object]
) -> None:
    context = {"max_off_mm": 1.2, "allowed_mm": 0.3, "allowed_off_mm": 1.0, **values}
    remedy = "Rest the hand, hold the tip still on the landmark, and touch it again."
    why = error_reason("CAPTURE_MOVED", message, remedy, context)
    assert not why.is_translated
    assert why.language("de") == "en"
    assert (why.message["de"], why.remedy["de"]) == (message, remedy)


def test_words_of_a_person_are_never_read_as_a_template() -> None:
    why = error_reason(
        "LANDMARK_NOT_TOUCHED",
        "the landmark '{code}' has not been captured",
        "Capture it first.",
        {"landmark": "{code}", "code": "L3"},
    )
    assert why.message["de"] == "die Landmarke „{code}“ ist nicht angetastet"
