"""Message catalogue (English, German) of headline and alarms, for video, page, API, log and report.

language.py     languages, and texts in all of them
alarms.py       texts of an alarm: present, past, or not observed
phrases.py      templates of each alarm condition
headline.py     verdict of an image, or the reason for missing figures, with unacknowledged alarms
camera_note.py  notes about the camera: video codec with prediction between images
flicker.py      lamp flicker and the exposure times that avoid it
states.py       reasons for missing figures
places.py       walls and directions

Headline, alarms and the reasons for missing figures are translated. Error messages are English only, because
they contain numbers and names; the page marks them with `lang="en"` for screen readers.
"""

from server.texts.alarms import AlarmText, alarm_text, alarm_title, with_unknown_presence
from server.texts.camera_note import PREDICTED_VIDEO, CameraNote
from server.texts.errors import error_reason, reason_of_error
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
    "reason",
    "reason_error",
    "reason_of_error",
    "requested_language",
    "set_requested_language",
    "with_unknown_presence",
    "withdrawal_text",
]
