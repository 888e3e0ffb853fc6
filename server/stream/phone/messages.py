"""What a page that sends its camera's images says, and what it is told; `socket.py` has the order."""

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from server.capture.phone import Focus, PhoneCamera
from server.live import SourceState
from server.stream.message import Message
from server.stream.messages import ProblemMessage

MAX_WIDTH_PX, MAX_HEIGHT_PX = 7680, 4320
MIN_SIDE_PX = 16
Milliseconds = Annotated[float, Field(ge=0.0, le=1e12, allow_inf_nan=False)]


class HelloMessage(Message):
    """Which page this is, so that it gets its place back after a loss of its connection."""

    key: Annotated[str, Field(pattern=r"^[0-9a-f]{32}$")]


class PongMessage(Message):
    """The answer to a ping, sent at once."""

    ping: Annotated[int, Field(ge=0, le=2**53)]
    at_ms: Milliseconds
    """The page's clock."""


class PhoneCameraMessage(Message):
    """What the browser granted; sent before the first image and after each change."""

    label: Annotated[str, Field(max_length=120)]
    width_px: Annotated[int, Field(ge=MIN_SIDE_PX, le=MAX_WIDTH_PX)]
    height_px: Annotated[int, Field(ge=MIN_SIDE_PX, le=MAX_WIDTH_PX)]
    rate_hz: Annotated[float, Field(ge=0.0, le=1000.0, allow_inf_nan=False)]
    focus: Focus
    focus_mm: Annotated[int, Field(ge=0, le=10**7)] | None
    zoom_percent: Annotated[int, Field(ge=1, le=10**5)] | None

    def camera(self) -> PhoneCamera:
        """The same as a record."""
        return PhoneCamera(
            label=self.label,
            size_wh_px=(self.width_px, self.height_px),
            rate_hz=self.rate_hz,
            focus=self.focus,
            focus_mm=self.focus_mm,
            zoom_percent=self.zoom_percent,
        )


class ImageMessage(Message):
    """An image follows, in parts."""

    bytes: Annotated[int, Field(ge=1, le=2**53)]
    captured_ms: Milliseconds
    """The page's clock."""
    clock: Literal["capture", "presentation"]
    """capture: as the browser says; presentation: when it was presented, which is later."""


class PhoneSaid(Message):
    """One text message of the page: exactly one of these."""

    hello: HelloMessage | None = None
    pong: PongMessage | None = None
    camera: PhoneCameraMessage | None = None
    image: ImageMessage | None = None

    @model_validator(mode="after")
    def _one(self) -> Self:
        if len(self.model_fields_set) != 1 or getattr(self, next(iter(self.model_fields_set))) is None:
            raise ValueError("exactly one of hello, pong, camera, image")
        return self


class WelcomeMessage(Message):
    """What the page is asked for."""

    width_px: int
    height_px: int
    rate_hz: float
    quality_ratio: float
    """Of the JPEG."""
    part_bytes: int
    """The largest part of an image in one message."""
    lock_focus: bool
    focus_mm: int | None
    """At the calibration in use; null where it is not known, and then what has settled is locked."""


class NoteMessage(Message):
    """Sent for each image that came, and twice a second: ping, credit, and how it goes."""

    ping: int
    credit: int
    """So many images may be sent on this connection, from its beginning."""
    images: int
    """So many were handed to the tracking process."""
    rate_hz: float
    delay_ms: float | None
    """From the capture of the last image to its arrival, at most; null before the first."""
    clock_error_ms: float | None
    """By how much `delay_ms` may be too long."""
    source_state: SourceState | None
    """Of the camera as the server has it; null while it is not known."""
    problem: ProblemMessage | None
    """Of the last image, of the camera, or of the tracking."""


class PhoneTold(Message):
    """One text message to the page: exactly one of these. After `refused` the connection is closed."""

    welcome: WelcomeMessage | None = None
    note: NoteMessage | None = None
    rejected: ProblemMessage | None = None
