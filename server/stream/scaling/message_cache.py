"""Live messages as text: the content of an instant is serialised once, the envelope for each viewer."""

from server.live import Instant
from server.stream.messages import live_content, live_envelope
from server.stream.scaling.sizes import PictureSize


class MessageCache:
    """Caches the content of the newest instant. For one event loop."""

    def __init__(self) -> None:
        self._instant: Instant | None = None
        self._members = ""
        self.serialised = 0
        """Number of serialised contents."""

    def of(self, instant: Instant, *, size: PictureSize = PictureSize.FULL, now_s: float) -> str:
        """Return a `LiveMessage` as JSON, sent at monotonic time `now_s` with a picture of this size."""
        if instant is not self._instant:
            self._members = _members(live_content(instant, now_s=now_s).model_dump_json())
            self._instant = instant
            self.serialised += 1
        envelope = live_envelope(instant, now_s=now_s, shown_scale_ratio=size.scale_ratio)
        return f"{{{_members(envelope.model_dump_json())},{self._members}}}"


def _members(json_object: str) -> str:
    """Return the members of a JSON object, without its braces."""
    return json_object[1:-1]
