"""Filter of messages from viewers of the scene. `server.security.hosts` checks who may connect."""

from dataclasses import dataclass
from enum import StrEnum
from importlib.metadata import version

import msgspec

# Message name of viser's client, repeated here to avoid importing viser.
SUBPROTOCOL = f"viser-v{version('viser')}"
CAMERA_MESSAGE = "ViewerCameraMessage"
LARGEST_MESSAGE_BYTES = 64 * 1024
# viser's client sends its camera at most 20 times a second while a person turns the view.
MESSAGES_PER_S = 60.0
BURST = 120.0
# Number of rejected messages after which a viewer is disconnected.
REJECTIONS_BEFORE_GOODBYE = 500


class Verdict(StrEnum):
    """Verdict on one message of a viewer."""

    CAMERA = "camera"  # the view was rotated
    TOO_LARGE = "too_large"
    TOO_OFTEN = "too_often"
    UNWANTED = "unwanted"  # any other message of viser, and invalid messages


class _Kind(msgspec.Struct):
    """The only field that is read."""

    type: str


@dataclass(kw_only=True, slots=True)
class Gate:
    """Filters the messages of one viewer. Times are passed in.

    All messages are counted and dropped, so that no handler of viser can be reached from a browser; only
    camera messages are expected.

    Attributes:
        counts: Number of messages by verdict.
    """

    counts: dict[Verdict, int]
    rejections: int = 0
    allowance: float = BURST
    judged_at_s: float | None = None

    def judge(self, message: bytes | str | None, *, now_s: float) -> Verdict:
        """Return the verdict on a message that arrived at monotonic time `now_s`."""
        if self.judged_at_s is not None:
            self.allowance = min(BURST, self.allowance + (now_s - self.judged_at_s) * MESSAGES_PER_S)
        self.judged_at_s = now_s
        verdict = self._verdict(message)
        self.counts[verdict] = self.counts.get(verdict, 0) + 1
        self.rejections += verdict is not Verdict.CAMERA
        return verdict

    @property
    def goodbye(self) -> bool:
        """Whether this viewer must be disconnected for too many rejected messages."""
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
        except (msgspec.DecodeError, UnicodeDecodeError, RecursionError):
            return Verdict.UNWANTED
        return Verdict.CAMERA if kind == CAMERA_MESSAGE else Verdict.UNWANTED
