"""Messages between a page that sends its camera's images and the server; `socket.py` has their order."""

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
    """Identifies the page, so that it keeps its slot after a lost connection."""

    key: Annotated[str, Field(pattern=r"^[0-9a-f]{32}$")]


class PongMessage(Message):
    """Immediate answer to a ping."""

    ping: Annotated[int, Field(ge=0, le=2**53)]
    at_ms: Milliseconds
    """The page's clock."""


class PhoneCameraMessage(Message):
    """Camera settings granted by the browser; sent before the first image and after each change."""

    label: Annotated[str, Field(max_length=120)]
    width_px: Annotated[int, Field(ge=MIN_SIDE_PX, le=MAX_WIDTH_PX)]
    height_px: Annotated[int, Field(ge=MIN_SIDE_PX, le=MAX_WIDTH_PX)]
    rate_hz: Annotated[float, Field(ge=0.0, le=1000.0, allow_inf_nan=False)]
    focus: Focus
    focus_mm: Annotated[int, Field(ge=0, le=10**7)] | None
    zoom_percent: Annotated[int, Field(ge=1, le=10**5)] | None

    def camera(self) -> PhoneCamera:
        """Return the same as a record."""
        return PhoneCamera(
            label=self.label,
            size_wh_px=(self.width_px, self.height_px),
            rate_hz=self.rate_hz,
            focus=self.focus,
            focus_mm=self.focus_mm,
            zoom_percent=self.zoom_percent,
        )


class ImageMessage(Message):
    """Announces an image, which follows in parts."""

    bytes: Annotated[int, Field(ge=1, le=2**53)]
    captured_ms: Milliseconds
    """The page's clock."""
    clock: Literal["capture", "presentation"]
    """capture: capture time of the browser; presentation: time of presentation, which is later."""


class PhoneClientMessage(Message):
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
    """Camera settings that the page shall use."""

    width_px: int
    height_px: int
    rate_hz: float
    quality_ratio: float
    """Of the JPEG."""
    part_bytes: int
    """Maximum size of a part of an image."""
    lock_focus: bool
    focus_mm: int | None
    """At the calibration in use; null where unknown, and then the settled focus is locked."""


class NoteMessage(Message):
    """Sent for each received image, and twice a second: ping, credit, and status."""

    ping: int
    credit: int
    """Number of images that may be sent on this connection, since its beginning."""
    images: int
    """Number of images passed to the tracking process."""
    rate_hz: float
    delay_ms: float | None
    """Upper bound of the time from capture to arrival of the last image; null before the first."""
    clock_error_ms: float | None
    """By how much `delay_ms` may be too large."""
    source_state: SourceState | None
    """State of the source on the server; null while unknown."""
    problem: ProblemMessage | None
    """Of the last image, of the camera, or of the tracking."""


class PhoneServerMessage(Message):
    """One text message to the page: exactly one of these. After `rejected` the connection is closed."""

    welcome: WelcomeMessage | None = None
    note: NoteMessage | None = None
    rejected: ProblemMessage | None = None
