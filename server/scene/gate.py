"""What a viewer of the scene may say. Who is let in at all is `server.security.hosts`' to judge."""

from dataclasses import dataclass
from enum import StrEnum
from importlib.metadata import version

import msgspec

# What viser's client names, without an import of viser.
SUBPROTOCOL = f"viser-v{version('viser')}"
CAMERA_MESSAGE = "ViewerCameraMessage"
LARGEST_MESSAGE_BYTES = 64 * 1024
# viser's client sends its camera at most 20 times a second while a person turns the view.
MESSAGES_PER_S = 60.0
BURST = 120.0
# A viewer that goes on like this is no viewer.
REJECTIONS_BEFORE_GOODBYE = 500


class Verdict(StrEnum):
    """What became of one message of a viewer."""

    CAMERA = "camera"  # the view was turned
    TOO_LARGE = "too_large"
    TOO_OFTEN = "too_often"
    UNWANTED = "unwanted"  # any other message that viser knows, and all that is no message


class _Kind(msgspec.Struct):
    """The one field that is looked at."""

    type: str


@dataclass(kw_only=True, slots=True)
class Gate:
    """Judges the messages of one viewer; time comes in as a number.

    Only the camera's messages are let in, and nobody needs them now: what a viewer sends is judged, counted
    and dropped here, so that no handler of viser can be reached from a browser.

    Attributes:
        counts: messages by verdict.
    """

    counts: dict[Verdict, int]
    rejections: int = 0
    allowance: float = BURST
    judged_at_s: float | None = None

    def judge(self, message: bytes | str | None, *, now_s: float) -> Verdict:
        """The verdict on one message that arrived at monotonic time `now_s`."""
        if self.judged_at_s is not None:
            self.allowance = min(BURST, self.allowance + (now_s - self.judged_at_s) * MESSAGES_PER_S)
        self.judged_at_s = now_s
        verdict = self._verdict(message)
        self.counts[verdict] = self.counts.get(verdict, 0) + 1
        self.rejections += verdict is not Verdict.CAMERA
        return verdict

    @property
    def goodbye(self) -> bool:
        """Whether this viewer is disconnected for too many rejected messages."""
        return self.rejections > REJECTIONS_BEFORE_GOODBYE

    def _verdict(self, message: bytes | str | None) -> Verdict:
        if self.allowance < 1.0:
            return Verdict.TOO_OFTEN
        self.allowance -= 1.0
        if not isinstance(message, bytes):
            return Verdict.UNWANTED
        if len(message) > LARGEST_MESSAGE_BYTES:
            return Verdict.TOO_LARGE
        try:
            kind = msgspec.msgpack.decode(message, type=_Kind).type
        except (msgspec.DecodeError, RecursionError):
            return Verdict.UNWANTED
        return Verdict.CAMERA if kind == CAMERA_MESSAGE else Verdict.UNWANTED
