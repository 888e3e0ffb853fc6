"""Messages to one client, including those on expired content.

A client shows the last pose until it receives another pose or a message that there is none. The feed
therefore stores an expiry time for the content of each device, from the limits of the page (`limits` in the
settings), and notifies the client at that time, also without a new image.
"""

from collections.abc import Iterable
from math import inf

from server.config import LimitsConfig
from server.openigtlink.contents import (
    HEADLINE,
    IS_TOO_OLD,
    PROGRAM,
    DeviceContent,
    InstantContents,
    status_of_device,
)
from server.openigtlink_wire import (
    Message,
    Status,
    StatusCode,
    capability_content,
    is_device_name,
    string_content,
)

SENT_TYPES = ("TRANSFORM", "POINT", "STRING", "STATUS", "CAPABILITY")
TAKEN_TYPES = ("GET_STATUS", "GET_CAPABIL", "STT_TRANSFOR", "STP_TRANSFOR")
# Both spellings are in use: the specification cuts the name at 12 bytes, older clients earlier.
STARTS, STOPS = ("STT_TRANSFOR", "STT_TRANS"), ("STP_TRANSFOR", "STP_TRANS")
SUCCESS = b"\0"
GONE = Status(code=StatusCode.NOT_PRESENT, name="GONE", text="GONE: no image, or the tool no longer exists")
STOPPED = Status(
    code=StatusCode.NOT_READY, name="STOPPED", text="STOPPED: this client has stopped the stream of poses"
)


class Feed:
    """The messages for one client. Times are monotonic; `unix_offset_s` is Unix time minus monotonic time.

    Args:
        limits: Ages from which the page hides figures and pictures.
    """

    def __init__(self, limits: LimitsConfig) -> None:
        self._figures_s = limits.pose_stale_after_ms / 1000.0
        self._reasons_s = limits.video_stale_after_ms / 1000.0
        # Expiry time of the client's content, by device.
        self._valid_until_s: dict[str, float] = {}
        # Content that is sent only when it changes.
        self._stated: dict[str, DeviceContent] = {}
        self._newest: InstantContents | None = None
        self._is_stopped = False

    @property
    def expires_at_s(self) -> float:
        """Time at which the client must be notified of expired content; infinity without content."""
        return min(self._valid_until_s.values(), default=inf)

    def messages(self, contents: InstantContents, *, now_s: float, unix_offset_s: float) -> list[Message]:
        """Return the messages of a new instant, for sending at once."""
        self._newest = contents
        if self._is_stopped:
            return []
        now_unix_s = now_s + unix_offset_s
        program, until_s = self._program(now_s)
        sent = [self._message(one, now_unix_s) for one in self._changed((program, contents.plan))]
        if contents.captured_at_s is None:
            # Both are sent again.
            for own in (PROGRAM, HEADLINE):
                self._valid_until_s.pop(own, None)
            sent += self._ended(list(self._valid_until_s), GONE, now_unix_s)
            return sent + [self._message(one, now_unix_s) for one in self._changed(contents.image)]
        self._stated.pop(HEADLINE, None)
        present = {PROGRAM, *(one.device for one in contents.image)}
        sent += self._ended([one for one in self._valid_until_s if one not in present], GONE, now_unix_s)
        self._valid_until_s[PROGRAM] = until_s
        for one in contents.image:
            until_s = contents.captured_at_s + (self._figures_s if one.has_figures else self._reasons_s)
            if now_s <= until_s:
                self._valid_until_s[one.device] = until_s
                sent.append(self._message(one, contents.captured_at_s + unix_offset_s))
            else:
                self._valid_until_s[one.device] = inf
                sent.append(self._ending(one.device, IS_TOO_OLD, now_unix_s))
        return sent

    def expired(self, *, now_s: float, unix_offset_s: float) -> list[Message]:
        """Return the messages on content that has expired."""
        old = [device for device, until_s in self._valid_until_s.items() if not now_s <= until_s]
        self._valid_until_s |= dict.fromkeys(old, inf)
        if PROGRAM in old:
            self._stated[PROGRAM] = _OLD_PROGRAM
        return [self._ending(device, IS_TOO_OLD, now_s + unix_offset_s) for device in old]

    def answer(self, request: Message, *, now_s: float, unix_offset_s: float) -> list[Message]:
        """Return the response to a message of the client; unknown messages are ignored, as specified."""
        now_unix_s = now_s + unix_offset_s
        device = request.device if is_device_name(request.device) else PROGRAM
        if request.type == "GET_STATUS":
            content = self._program(now_s)[0].content
            return [Message(type="STATUS", device=device, timestamp_s=now_unix_s, content=content)]
        if request.type == "GET_CAPABIL":
            content = capability_content([*SENT_TYPES, *TAKEN_TYPES])
            return [Message(type="CAPABILITY", device=device, timestamp_s=now_unix_s, content=content)]
        if request.type not in {*STARTS, *STOPS}:
            return []
        ended: list[Message] = []
        self._is_stopped = request.type in STOPS
        if self._is_stopped:
            self._valid_until_s.pop(PROGRAM, None)
            ended = self._ended(list(self._valid_until_s), STOPPED, now_unix_s)
            self._stated.clear()
        reply = f"RTS_{request.type.removeprefix(request.type[:4])}"
        return [*ended, Message(type=reply, device=device, timestamp_s=now_unix_s, content=SUCCESS)]

    def _program(self, now_s: float) -> tuple[DeviceContent, float]:
        """Return the state of the program, and its expiry time."""
        if self._newest is None:
            return _NOTHING_YET, inf
        captured_at_s = self._newest.captured_at_s
        if captured_at_s is None:
            return self._newest.program, inf
        until_s = captured_at_s + self._reasons_s
        return (self._newest.program, until_s) if now_s <= until_s else (_OLD_PROGRAM, inf)

    def _changed(self, contents: Iterable[DeviceContent]) -> list[DeviceContent]:
        changed = [one for one in contents if self._stated.get(one.device) != one]
        self._stated |= {one.device: one for one in changed}
        return changed

    def _ended(self, devices: list[str], status: Status, at_s: float) -> list[Message]:
        for device in devices:
            del self._valid_until_s[device]
        return [self._ending(device, status, at_s) for device in devices]

    def _ending(self, device: str, status: Status, at_s: float) -> Message:
        if device == HEADLINE:
            # A client shows a text until it receives another one.
            return Message(
                type="STRING", device=device, timestamp_s=at_s, content=string_content(status.text)
            )
        return self._message(status_of_device(device, status), at_s)

    def _message(self, one: DeviceContent, at_s: float) -> Message:
        return Message(
            type=one.type,
            device=one.device,
            timestamp_s=at_s,
            content=one.content,
            metadata={"Coordinates": one.coordinates} if one.coordinates else {},
        )


_NOTHING_YET = status_of_device(
    PROGRAM, Status(code=StatusCode.NOT_READY, name="NO_IMAGE", text="NO_IMAGE: the server has just started")
)
_OLD_PROGRAM = status_of_device(PROGRAM, IS_TOO_OLD)
