"""The card shown without an image, with reason and time."""

from datetime import datetime

from server.live import Instant, ProcessState, SourceState
from server.overlay import draw_card, encode_jpeg

TITLE = "NO VIDEO"
DEFAULT_SIZE_WH_PX = (1280, 720)
CARD_QUALITY = 85

PROCESS_TEXTS = {
    ProcessState.STARTING: "Tracking is starting.",
    ProcessState.RESTARTING: "Tracking has stopped and is being restarted.",
    ProcessState.GIVEN_UP: "Tracking has stopped too often and is not restarted.",
}
SOURCE_TEXTS = {
    SourceState.OPENING: "The image source is being opened.",
    SourceState.RECONNECTING: "The image source has stopped and is being reconnected.",
    SourceState.ENDED: "The image source has ended.",
    SourceState.RUNNING: "Waiting for the first image.",
}


def reasons_for_no_video(instant: Instant | None, *, now_s: float) -> tuple[str, ...]:
    """Return sentences that state why there is no image, and the remedy.

    The image of an instant with a snapshot is assumed to be too old.
    """
    if instant is None:
        return (PROCESS_TEXTS[ProcessState.STARTING],)
    for part in (instant.process, instant.source):
        if part.problem is not None:
            return f"{_upper_first(part.problem.message)}.", part.problem.remedy
    if instant.process.state in PROCESS_TEXTS:
        return (PROCESS_TEXTS[instant.process.state],)
    if instant.snapshot is not None and instant.source.state is SourceState.RUNNING:
        # Whole seconds, so that the card is drawn once a second for all viewers.
        age_s = int(now_s - instant.snapshot.captured_at_s)
        return (f"No new image for {age_s} s." if age_s >= 1 else "No new image.",)
    return (SOURCE_TEXTS[instant.source.state],)


class NoVideoCard:
    """Draws the card once for all viewers, and again when its text changes."""

    def __init__(self) -> None:
        self._key: tuple[object, ...] = ()
        self._jpeg = b""
        self._size_wh_px = DEFAULT_SIZE_WH_PX

    def jpeg(self, instant: Instant | None, *, now_s: float, clock: datetime) -> bytes:
        """Return the card for this instant, in the size of the last image, with the time of day."""
        if instant is not None and instant.snapshot is not None:
            self._size_wh_px = instant.snapshot.size_wh_px
        lines = (*reasons_for_no_video(instant, now_s=now_s), clock.strftime("%H:%M:%S"))
        key = (self._size_wh_px, lines)
        if key != self._key:
            card = draw_card(size_wh_px=self._size_wh_px, title=TITLE, lines=lines)
            self._jpeg, self._key = encode_jpeg(card, CARD_QUALITY), key
        return self._jpeg


def _upper_first(sentence: str) -> str:
    return sentence[:1].upper() + sentence[1:]
