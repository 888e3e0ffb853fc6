"""Topics of a recording. Messages are JSON unless it is said otherwise; their schemas are in the file."""

from enum import StrEnum

PROFILE = "coaxial"
# Grows with each change that an older version cannot read.
FORMAT_VERSION = 1
SUFFIX = ".mcap"
JSON = "json"
ZSTD_JSON = "zstd+json"
SCHEMA_ENCODING = "jsonschema"


class Topic(StrEnum):
    """What is recorded."""

    SESSION = "/session"  # versions, machine, settings; first in the file
    IMAGE = "/image"  # a JPEG or packed pixels, see the channel's metadata
    TRACKED = "/tracked"  # what tracking got beside the image
    SNAPSHOT = "/snapshot"  # the result for it, as in the live message
    STATE = "/state"  # of tracking before the next image; Zstandard, JSON
    SOURCE = "/source"  # state of source and camera, as in the live message, when it changes
    ALARM_STATE = "/alarms/state"  # before the first step; Zstandard, JSON
    ALARM_STEP = "/alarms/step"  # each step of the alarms, with its circumstances
    ALARMS = "/alarms"  # as in the live message, when they change
    DOCUMENTS = "/documents"  # the documents of the case in use, when they change
    MARKS = "/marks"  # what supervisors draw and point at
    NOTE = "/note"  # images that are missing, and the end
