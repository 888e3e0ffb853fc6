"""Headline and alarms in words: one catalogue in every language for video, page, wire, log and report.

language.py     the languages, and a text in all of them
alarms.py       an alarm: present, in the past tense, not tracked, or beside figures that are not live
phrases.py      what is said of each alarm: the table
headline.py     the verdict of an image, or why it has no figures, with the alarms that are not acknowledged
flicker.py      lamps that flicker, and the exposures that even them out
states.py       why there are no figures
places.py       walls and directions

Headline, alarms and the reasons for missing figures are written here in both languages. Error messages stay
English, because they carry numbers, names and remedies that no catalogue by code could hold; the page marks
them with `lang="en"` so that a screen reader pronounces them.
"""

from server.texts.alarms import AlarmText, alarm_text, alarm_title, without_live_figures
from server.texts.flicker import CameraNote, flicker_note
from server.texts.headline import Headline, Tone, headline_of
from server.texts.language import LANGUAGES, Language, Text

__all__ = [
    "LANGUAGES",
    "AlarmText",
    "CameraNote",
    "Headline",
    "Language",
    "Text",
    "Tone",
    "alarm_text",
    "alarm_title",
    "flicker_note",
    "headline_of",
    "without_live_figures",
]
