"""What can go wrong for one who wants to watch."""

from collections.abc import Sequence

from tracker.errors import NavigationError


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
