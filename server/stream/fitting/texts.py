"""The message of an instant as text: written once for all who watch, each with its own moment of sending.

What is true of one sending alone are three numbers: when it was sent, how old the image was then, and in
which size its picture goes with it. The rest of the text is the same for everybody.
"""

import re

from server.live import Instant
from server.stream.fitting.sizes import Size
from server.stream.messages import live_message

NUMBER = r"-?[0-9.eE+-]+"
SENT = re.compile(rf'"sent_at_s":{NUMBER},"shown_scale_ratio":{NUMBER}')
AGE = re.compile(rf'("snapshot":{{"image_number":\d+,"captured_at_s":{NUMBER},"age_ms":){NUMBER}')


class Texts:
    """Keeps the text of the newest instant that was asked for. Used in one event loop."""

    def __init__(self) -> None:
        self._instant: Instant | None = None
        self._parts: tuple[str, ...] = ()
        self.written = 0
        """How many texts were written."""

    def of(self, instant: Instant, *, size: Size = Size.FULL, now_s: float) -> str:
        """A `LiveMessage` as JSON, as sent at monotonic time `now_s` with a picture of this size."""
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
    """What stands around the numbers of one sending."""
    sent, age = SENT.search(text), AGE.search(text)
    if sent is None:
        raise ValueError("a live message does not say when it was sent")
    if age is None:
        return text[: sent.start()], text[sent.end() :]
    return text[: sent.start()], text[sent.end() : age.end(1)], text[age.end() :]
