"""Errors of viewers."""

from collections.abc import Sequence

from tracker.errors import NavigationError


class TooManyViewers(NavigationError):
    """The maximum number of viewers, or of connections of one person, is reached."""

    def __init__(self, watching: int, maximum: int, name: str | None = None) -> None:
        if name is None:
            super().__init__(
                "TOO_MANY_VIEWERS",
                f"{watching} viewers are connected, the maximum is {maximum}",
                "Close an unused view, or raise video.max_viewers in the settings.",
                {"watching": watching, "max_watching": maximum, "name": None},
            )
        else:
            super().__init__(
                "TOO_MANY_VIEWERS",
                f"{name} has {watching} open connections, the maximum per person is {maximum}",
                "Close an unused page.",
                {"watching": watching, "max_watching": maximum, "name": name},
            )

    def __reduce__(self) -> tuple[object, ...]:
        """Pickle by the constructor's arguments."""
        return type(self), (self.context["watching"], self.context["max_watching"], self.context["name"])


class CameraUnknown(NavigationError):
    """There is no camera of this name."""

    def __init__(self, requested: str, known: Sequence[str]) -> None:
        super().__init__(
            "CAMERA_UNKNOWN",
            f"there is no camera '{requested[:80]}', only {', '.join(known)}",
            "Use one of these cameras, or configure another one in the settings.",
            {"requested": requested[:80], "known": list(known), "cameras": ", ".join(known)},
        )

    def __reduce__(self) -> tuple[object, ...]:
        """Pickle by the constructor's arguments."""
        return type(self), (self.context["requested"], self.context["known"])
