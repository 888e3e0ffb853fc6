"""What can go wrong in the server, beside what can go wrong in the tracker.

tracker.errors.NavigationError
├── ConfigError       a setting cannot be used                        the start is refused
├── CaptureError      the source of images gives none                 HTTP 503, tried again by itself
└── SetupOrderError   a step is asked for before the one it stands on HTTP 409
"""

from tracker.errors import NavigationError


class ConfigError(NavigationError):
    """A setting cannot be used: the file, the key, the value, and what is allowed are in the message."""


class CaptureError(NavigationError):
    """The source of images cannot be opened, gives no image, or has stopped."""


class SetupOrderError(NavigationError):
    """A step was asked for before the one that it stands on."""
