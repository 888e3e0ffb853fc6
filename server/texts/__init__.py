"""Message catalogue (English, German), for video, page, API, log and report.

language.py     languages, and texts in all of them
requested.py    the language that a request states with `Accept-Language`
alarms.py       texts of an alarm: present, past, or not observed
phrases.py      templates of each alarm condition
headline.py     verdict of an image, or the reason for missing figures, with unacknowledged alarms
camera_note.py  notes about the camera: video codec with prediction between images
flicker.py      lamp flicker and the exposure times that avoid it
states.py       reasons for missing figures
places.py       walls and directions
reason.py       a reason: its code, its values, and its sentences in all languages
steps.py        reasons of the steps of the procedure and of documents that are out of date, by code
errors/         translations of errors by code, a module an area, of their remedies, and of phrases in them

A message that all viewers share (headline, alarms, problems of camera and tracking) has all languages; an
answer to a request has the language of the request. A value is formatted by the template of each language
with the same format, so that its digits are the same. Texts that a person typed, names of devices and what
another program reported are not translated.

An error is raised in English. To translate one, add its template to the module of its area, its remedy to
`errors/remedies` and the parts that depend on the case to `errors/phrases`, and give the error its values by
name in `context`. `tests/server/texts/test_error_texts.py` requires German of each error that a page shows.
A warning about completed work (`tracker.errors.Remark`) is stored with its code and values, and `worded`
finds its sentences in the same way when a document is read.
"""

from server.texts.alarms import AlarmText, alarm_text, alarm_title, with_unknown_presence
from server.texts.camera_note import PREDICTED_VIDEO, CameraNote
from server.texts.errors import error_reason, phrase_text, reason_of_error, worded
from server.texts.flicker import flicker_note
from server.texts.headline import Headline, Tone, headline_of
from server.texts.language import LANGUAGES, NO_TEXT, Language, Text
from server.texts.reason import Reason, Value, as_is, document_title, reason, reason_error, withdrawal_text
from server.texts.requested import accepted_language, requested_language, set_requested_language
from server.texts.states import STATES
from server.texts.steps import CONFIRM, KINDS, METHODS, STEPS, WITHDRAWALS

__all__ = [
    "CONFIRM",
    "KINDS",
    "LANGUAGES",
    "METHODS",
    "NO_TEXT",
    "PREDICTED_VIDEO",
    "STATES",
    "STEPS",
    "WITHDRAWALS",
    "AlarmText",
    "CameraNote",
    "Headline",
    "Language",
    "Reason",
    "Text",
    "Tone",
    "Value",
    "accepted_language",
    "alarm_text",
    "alarm_title",
    "as_is",
    "document_title",
    "error_reason",
    "flicker_note",
    "headline_of",
    "phrase_text",
    "reason",
    "reason_error",
    "reason_of_error",
    "requested_language",
    "set_requested_language",
    "with_unknown_presence",
    "withdrawal_text",
    "worded",
]
