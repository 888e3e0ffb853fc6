"""Errors of the server, in addition to those of the tracker.

tracker.errors.NavigationError
├── ConfigError       a setting is invalid                            the server does not start
├── CaptureError      the image source delivers no images             HTTP 503, retried automatically
├── RecordingError    a recording cannot be written or read          it stops; navigation continues
└── SetupOrderError   a step is requested before its prerequisite     HTTP 409
"""

from tracker.errors import NavigationError


class ConfigError(NavigationError):
    """A setting is invalid; the message contains file, key, value and the allowed values."""


class CaptureError(NavigationError):
    """The image source cannot be opened, delivers no image, or has stopped."""


class SetupOrderError(NavigationError):
    """A step was requested before its prerequisite."""


class RecordingError(NavigationError):
    """A recording cannot be started, written or read."""
