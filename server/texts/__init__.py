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
from server.texts.flicker import flicker_note
from server.texts.headline import Headline, Tone, headline_of
from server.texts.language import LANGUAGES, Language, Text
from server.texts.states import STATES

__all__ = [
    "LANGUAGES",
    "PREDICTED_VIDEO",
    "STATES",
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
    "with_unknown_presence",
]
