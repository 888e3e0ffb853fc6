"""What can go wrong for one who wants to watch."""

from collections.abc import Sequence

from tracker.errors import NavigationError


class TooManyViewers(NavigationError):
    """As many watch as are allowed."""

    def __init__(self, watching: int, most: int) -> None:
        super().__init__(
            "TOO_MANY_VIEWERS",
            f"{watching} viewers watch already, at most {most} may",
            "Close a picture that nobody looks at, or raise video.most_viewers in the settings.",
            {"watching": watching, "most": most},
        )

    def __reduce__(self) -> tuple[object, ...]:
        """Made again from what it was made of."""
        return type(self), (self.context["watching"], self.context["most"])


class CameraUnknown(NavigationError):
    """There is no camera of this name."""

    def __init__(self, asked: str, known: Sequence[str]) -> None:
        super().__init__(
            "CAMERA_UNKNOWN",
            f"there is no camera '{asked[:80]}', only {', '.join(known)}",
            "Ask for one of these cameras, or name another one in the configuration.",
            {"asked": asked[:80], "known": list(known)},
        )

    def __reduce__(self) -> tuple[object, ...]:
        """Made again from what it was made of."""
        return type(self), (self.context["asked"], self.context["known"])
