"""What can go wrong for one who wants to watch."""

from collections.abc import Sequence

from tracker.errors import NavigationError


class TooManyViewers(NavigationError):
    """As many watch as are allowed; or one person has as many lines open as one may."""

    def __init__(self, watching: int, most: int, name: str | None = None) -> None:
        said = f"{watching} viewers watch already, at most {most} may"
        remedy = "Close a picture that nobody looks at, or raise video.max_viewers in the settings."
        if name is not None:
            said = f"{name} has {watching} lines open already, at most {most} may be one person's"
            remedy = "Close a page of yours that nobody looks at."
        super().__init__("TOO_MANY_VIEWERS", said, remedy, {"watching": watching, "most": most, "name": name})

    def __reduce__(self) -> tuple[object, ...]:
        """Made again from what it was made of."""
        return type(self), (self.context["watching"], self.context["most"], self.context["name"])


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
