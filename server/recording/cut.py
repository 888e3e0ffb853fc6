"""Write a part of a recording as a new recording, which replays as exactly as the original.

A replay is exact from a stored tracking state on. A part therefore starts at the newest state before the
requested start, up to `process.STATE_PERIOD_S` earlier. Bytes and times of its messages are unchanged. The
last session, documents, source and alarms before the start are written first, at the time of the first image.
"""

from dataclasses import dataclass
from math import inf
from pathlib import Path

from server.disk import is_full, named_when_complete
from server.errors import RecordingError
from server.recording.messages import NoteMessage
from server.recording.timeline import Report
from server.recording_file import RecordedMessage, RecordingReader, Topic, rejecting_other_content
from server.recording_file.copy import RecordingCopy
from server.recording_file.locations import Location, MessageLocations

# Topics whose last message is in effect until the next one.
LASTING = (Topic.DOCUMENTS, Topic.SOURCE, Topic.ALARMS)
# Alarm steps are written by another thread than images, and may follow later images in the file.
MAX_DISORDER_S = 5.0
# Tolerance for image times: a float resolves Unix time to a quarter of a microsecond.
ROUNDING_S = 1e-6


@dataclass(frozen=True, slots=True, kw_only=True)
class CutSummary:
    """Summary of a part.

    Attributes:
        images: Number of images.
        from_s: Time of its first image, since the first image of the original.
        to_s: Time of its last image, since the first image of the original.
        missing_images: Tracked images in this period that were not recorded; after them the replay is exact
            only from the next state on.
        is_exact: Whether it starts with a state, without which it cannot be replayed.
    """

    images: int
    missing_images: int
    from_s: float
    to_s: float
    is_exact: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class _Begin:
    """Start of a part: number of its first image, and whether the state before it is stored."""

    number: int
    unix_s: float
    has_state: bool


def cut_recording(
    recording: Path,
    target: Path,
    *,
    from_s: float,
    to_s: float,
    report: Report = lambda _ratio, _doing: None,
) -> CutSummary:
    """Write the part of a recording between two times.

    Args:
        recording: The original.
        target: The part; overwritten.
        from_s: Start, since the first image of the original.
        to_s: End, since the first image of the original.
        report: Called with the completed share (0 to 1) and the present activity.

    Raises:
        RecordingError: RECORDING_NOT_READABLE, RECORDING_DAMAGED, CUT_EMPTY, CUT_NOT_WRITTEN.
    """
    first_s, begin = _begin(recording, from_s, to_s)
    end_s = first_s + to_s + ROUNDING_S
    reader = RecordingReader(recording)
    try:
        with (
            rejecting_other_content(recording),
            named_when_complete(target) as unfinished,
            RecordingCopy(unfinished, reader) as copy,
        ):
            piece = _Piece(copy, begin, end_s)
            for message in reader.messages():
                if message.topic is Topic.IMAGE and message.unix_s > end_s + MAX_DISORDER_S:
                    break
                piece.take(message)
                report((message.unix_s - first_s) / max(end_s - first_s, 1e-3), "cutting")
            if reader.is_damaged:
                raise RecordingError(
                    "RECORDING_DAMAGED",
                    f"{recording.name} cannot be read up to {to_s:.1f} s: {reader.incomplete_reason}",
                    "Choose a part before the damage, or take the recording from another copy.",
                    {"name": recording.name, "to_s": to_s, "incomplete_reason": reader.incomplete_reason},
                )
            piece.end(recording.name, first_s=first_s, from_s=from_s, to_s=to_s)
    except OSError as error:
        what = "the disk is full" if is_full(error) else (error.strerror or str(error)).lower()
        raise RecordingError(
            "CUT_NOT_WRITTEN",
            f"{target.name} cannot be written: {what}",
            "Check that its folder exists and its disk has free space, then try again.",
            {"name": target.name, "write_problem": what, "system_error": what},
        ) from error
    finally:
        reader.close()
    return CutSummary(
        images=piece.images,
        missing_images=piece.missing_images,
        from_s=begin.unix_s - first_s,
        to_s=piece.last_s - first_s,
        is_exact=begin.has_state,
    )


def _begin(recording: Path, from_s: float, to_s: float) -> tuple[float, _Begin]:
    """Return the time of the first image of the original, and the start of the part.

    Raises:
        RecordingError: CUT_EMPTY, RECORDING_NOT_READABLE.
    """
    first_s, last_s = inf, -inf
    state: Location | None = None
    image: Location | None = None
    for location in MessageLocations(recording):
        if location.topic is Topic.STATE and location.unix_s <= first_s + from_s + ROUNDING_S:
            state = location
        elif location.topic is Topic.IMAGE:
            first_s = min(first_s, location.unix_s)
            last_s = location.unix_s
            if image is None and location.unix_s >= first_s + from_s - ROUNDING_S:
                image = location
    if image is None or not from_s <= to_s or image.unix_s > first_s + to_s + ROUNDING_S:
        has = f"has images from 0 to {last_s - first_s:.1f} s" if last_s >= first_s else "has no image"
        raise RecordingError(
            "CUT_EMPTY",
            f"there is no image from {from_s:.1f} to {to_s:.1f} s; {recording.name} {has}",
            "Give a period with images, and a start before its end.",
            {
                "from_s": from_s,
                "to_s": to_s,
                "last_s": last_s - first_s,
                "name": recording.name,
                "image_range": has,
            },
        )
    start = image if state is None else state
    return first_s, _Begin(number=start.sequence, unix_s=start.unix_s, has_state=state is not None)


class _Piece:
    def __init__(self, copy: RecordingCopy, begin: _Begin, end_s: float) -> None:
        self.images, self.missing_images, self.last_s = 0, 0, begin.unix_s
        self._copy, self._begin, self._end_s = copy, begin, end_s
        self._lasting: dict[Topic, RecordedMessage] = {}
        self._has_begun = self._has_alarms = False
        self._last_ns = 0

    def take(self, message: RecordedMessage) -> None:
        """Copy the message if it belongs to the part."""
        if not self._has_begun:
            if message.topic is Topic.SESSION or message.topic in LASTING:
                self._lasting[message.topic] = message
            if not self._is_first(message):
                return
            self._has_begun = True
            # SESSION stays the first message.
            for lasting in self._lasting.values():
                self._copy.add(lasting, log_ns=message.log_ns)
        if message.unix_s > self._end_s:
            return
        if message.topic is Topic.ALARM_STATE:
            self._has_alarms = True
        elif message.topic is Topic.ALARM_STEP and self._begin.has_state and not self._has_alarms:
            # Belongs to images before the part.
            return
        elif message.topic is Topic.NOTE:
            self.missing_images += int(message.json()["images"])
        self._copy.add(message)
        self._last_ns = max(self._last_ns, message.log_ns)
        if message.topic is Topic.SNAPSHOT:
            self.images += 1
            self.last_s = message.unix_s

    def end(self, name: str, *, first_s: float, from_s: float, to_s: float) -> None:
        """Add a note that this is a part of another recording."""
        begins_s = self._begin.unix_s - first_s
        text = f"cut from {name}: {from_s:.1f} to {to_s:.1f} s after its first image"
        text += (
            f", starting at the stored state at {begins_s:.1f} s"
            if self._begin.has_state
            else "; it cannot be replayed, because no state is stored before it"
        )
        self._copy.add_json(
            Topic.NOTE,
            NoteMessage(code="CUT", message=text).model_dump_json(),
            log_ns=self._last_ns,
            schema=NoteMessage.model_json_schema(),
        )

    def _is_first(self, message: RecordedMessage) -> bool:
        topic = Topic.STATE if self._begin.has_state else Topic.TRACKED
        return (
            message.topic is topic
            and message.sequence == self._begin.number
            and message.unix_s == self._begin.unix_s
        )
