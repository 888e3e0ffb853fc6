"""Live messages as text: serialised once for all viewers.

Three numbers differ between viewers: send time, age of the image at that time, and picture size. All other
text is equal.
"""

import re

from server.live import Instant
from server.stream.messages import live_message
from server.stream.scaling.sizes import PictureSize

NUMBER = r"-?[0-9.eE+-]+"
SENT = re.compile(rf'"sent_at_s":{NUMBER},"shown_scale_ratio":{NUMBER}')
AGE = re.compile(rf'("snapshot":{{"image_number":\d+,"captured_at_s":{NUMBER},"age_ms":){NUMBER}')


class MessageCache:
    """Caches the text of the newest instant. For one event loop."""

    def __init__(self) -> None:
        self._instant: Instant | None = None
        self._parts: tuple[str, ...] = ()
        self.written = 0
        """Number of serialised messages."""

    def of(self, instant: Instant, *, size: PictureSize = PictureSize.FULL, now_s: float) -> str:
        """Return a `LiveMessage` as JSON, sent at monotonic time `now_s` with a picture of this size."""
        if instant is not self._instant:
            self._parts = _parts(live_message(instant, now_s=now_s).model_dump_json())
            self._instant = instant
            self.written += 1
        sent = f'"sent_at_s":{now_s!r},"shown_scale_ratio":{size.scale_ratio!r}'
        if instant.snapshot is None:
            before, after = self._parts
            return f"{before}{sent}{after}"
        before, between, after = self._parts
        age_ms = (now_s - instant.snapshot.captured_at_s) * 1000.0
        return f"{before}{sent}{between}{age_ms!r}{after}"


def _parts(text: str) -> tuple[str, ...]:
    """Split the text at the numbers that differ between viewers."""
    sent, age = SENT.search(text), AGE.search(text)
    if sent is None:
        raise ValueError("the live message has no send time")
    if age is None:
        return text[: sent.start()], text[sent.end() :]
    return text[: sent.start()], text[sent.end() : age.end(1)], text[age.end() :]
