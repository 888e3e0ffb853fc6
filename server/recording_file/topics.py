"""Topics of a recording. Messages are JSON unless stated otherwise; their schemas are in the file."""

from enum import StrEnum

PROFILE = "coaxial"
# Incremented by each change that an older version cannot read.
FORMAT_VERSION = 2
SUFFIX = ".mcap"
JSON = "json"
ZSTD_JSON = "zstd+json"
SCHEMA_ENCODING = "jsonschema"


class Topic(StrEnum):
    """Topic of a message."""

    SESSION = "/session"  # versions, machine, settings; first in the file
    IMAGE = "/image"  # a JPEG or compressed pixels, see the channel's metadata
    TRACKED = "/tracked"  # input of tracking other than the image
    POSES = "/poses"  # poses of the markers with their covariances
    SNAPSHOT = "/snapshot"  # result of the image, as in the live message
    STATE = "/state"  # tracking state before the next image; Zstandard, JSON
    SOURCE = "/source"  # state of source and camera, as in the live message, when it changes
    ALARM_STATE = "/alarms/state"  # alarm state before the first step; Zstandard, JSON
    ALARM_STEP = "/alarms/step"  # each alarm step, with its circumstances
    ALARMS = "/alarms"  # as in the live message, when they change
    DOCUMENTS = "/documents"  # the documents of the case in use, when they change
    MARKS = "/marks"  # drawings and pointers of supervisors
    NOTE = "/note"  # missing images, and the end
