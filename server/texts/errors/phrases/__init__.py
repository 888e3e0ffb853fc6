"""Phrases in the messages of errors, by the name of the value that has one; a module an area.

Names are those in `context`, where a phrase is given in English. Its templates are filled with the other
values of the same error. A template without formats is also compared with the phrase, and its values are read
from it; they may be phrases themselves. An error with a phrase that is not listed here stays English.
"""

from collections.abc import Mapping

from server.texts.errors.phrases.access import ACCESS
from server.texts.errors.phrases.accuracy import ACCURACY
from server.texts.errors.phrases.camera import CAMERA
from server.texts.errors.phrases.cases import CASES
from server.texts.errors.phrases.labels import LABELS
from server.texts.errors.phrases.process import PROCESS
from server.texts.errors.phrases.recordings import RECORDINGS
from server.texts.errors.phrases.registration import REGISTRATION
from server.texts.errors.phrases.remarks import REMARKS
from server.texts.errors.phrases.tool import TOOL
from server.texts.language import Text

# A name in two areas would lose the phrases of one.
AREAS = (
    ACCESS,
    ACCURACY,
    CAMERA,
    CASES,
    LABELS,
    PROCESS,
    RECORDINGS,
    REGISTRATION,
    REMARKS,
    TOOL,
)
PHRASES: Mapping[str, tuple[Text, ...]] = {name: phrases for area in AREAS for name, phrases in area.items()}
