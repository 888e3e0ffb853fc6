"""What one page sends, in order: round trips, its camera, and images in parts. Without I/O."""

from dataclasses import dataclass

from pydantic import ValidationError

from server.capture.jpeg_header import jpeg_size_wh_px
from server.capture.phone import PhoneCamera, broken_image
from server.live import ImageClock, Problem
from server.loop.phone_inbox import MAX_JPEG_BYTES
from server.stream.phone.messages import (
    MAX_HEIGHT_PX,
    MAX_WIDTH_PX,
    MIN_SIDE_PX,
    HelloMessage,
    ImageMessage,
    PhoneSaid,
    PongMessage,
)
from server.stream.phone.page_clock import PageClock
from server.stream.socket import LARGEST_MESSAGE_BYTES, REJECTED, TOO_LARGE, Misbehaviour

# One on the way and one being made: the line is never idle, and no more than these can grow old.
MAX_IMAGES_UNDERWAY = 2
MAX_PINGS_OPEN = 64


@dataclass(frozen=True, slots=True, kw_only=True)
class Received:
    """A whole JPEG of a size that is allowed.

    Attributes:
        jpeg: the image.
        captured_at_s: this machine's monotonic clock, never later than the capture.
        arrived_s: when its last part came.
        clock: whose time the capture is.
        camera: that took it.
    """

    jpeg: bytes
    captured_at_s: float
    arrived_s: float
    clock: ImageClock
    camera: PhoneCamera


@dataclass(frozen=True, slots=True, kw_only=True)
class Grant:
    """A ping, and how many images may be sent on this connection from its beginning."""

    ping: int
    credit: int


class Sender:
    """The side of the server of one connection, after the page has said hello. Times are passed in."""

    def __init__(self) -> None:
        self.clock = PageClock()
        self._camera: PhoneCamera | None = None
        self._pings: dict[int, float] = {}
        self._next_ping = 0
        self._announced = 0
        self._received = 0
        self._granted = 0
        self._image: ImageMessage | None = None
        self._parts: list[bytes] = []
        self._part_bytes = 0

    def grant(self, now_s: float) -> Grant:
        """What is granted now, with a ping."""
        ping, self._next_ping = self._next_ping, self._next_ping + 1
        self._pings[ping] = now_s
        while len(self._pings) > MAX_PINGS_OPEN:
            del self._pings[next(iter(self._pings))]
        self._granted = self._received + MAX_IMAGES_UNDERWAY
        return Grant(ping=ping, credit=self._granted)

    def hear(self, text: str, now_s: float) -> None:
        """One text message.

        Raises:
            Misbehaviour: it is not understood, or not due.
        """
        said = said_in(text)
        if said.pong is not None:
            self._take_pong(said.pong, now_s)
        elif said.camera is not None:
            self._camera = said.camera.camera()
        elif said.image is not None:
            self._begin(said.image)
        else:
            raise Misbehaviour(REJECTED, "hello is said once, at the beginning")

    def take_part(self, part: bytes, now_s: float) -> Received | Problem | None:
        """One part of an image: the image when it is whole, what is wrong with it, or None until then.

        Raises:
            Misbehaviour: no image was announced, or it is longer than announced.
        """
        image, camera = self._image, self._camera
        if image is None or camera is None or not part:
            raise Misbehaviour(REJECTED, "an image is announced before its parts")
        self._parts.append(part)
        self._part_bytes += len(part)
        if self._part_bytes > image.bytes:
            raise Misbehaviour(TOO_LARGE, f"{image.bytes} bytes were announced, {self._part_bytes} came")
        if self._part_bytes < image.bytes:
            return None
        jpeg = b"".join(self._parts)
        self._image, self._parts, self._part_bytes = None, [], 0
        self._received += 1
        problem = _problem_of(jpeg)
        if problem is not None:
            return problem
        captured_at_s = min(self.clock.captured_at_s(image.captured_ms / 1000.0), now_s)
        clock = ImageClock.BROWSER if image.clock == "capture" else ImageClock.ARRIVAL
        return Received(jpeg=jpeg, captured_at_s=captured_at_s, arrived_s=now_s, clock=clock, camera=camera)

    def _take_pong(self, pong: PongMessage, now_s: float) -> None:
        sent_s = self._pings.pop(pong.ping, None)
        if sent_s is None:
            raise Misbehaviour(REJECTED, f"ping {pong.ping} was answered before, or never sent")
        self.clock.take(sent_s=sent_s, page_s=pong.at_ms / 1000.0, received_s=now_s)

    def _begin(self, image: ImageMessage) -> None:
        if self._image is not None:
            raise Misbehaviour(REJECTED, f"{self._part_bytes} of {self._image.bytes} bytes came of an image")
        if self._camera is None:
            raise Misbehaviour(REJECTED, "the camera is described before its first image")
        if not self.clock.is_known:
            raise Misbehaviour(REJECTED, "a ping is answered before the first image")
        if self._announced >= self._granted:
            raise Misbehaviour(REJECTED, f"{self._granted} images were granted, and one more was sent")
        if image.bytes > MAX_JPEG_BYTES:
            raise Misbehaviour(
                TOO_LARGE, f"an image of {image.bytes} bytes, at most {MAX_JPEG_BYTES} are taken"
            )
        self._image = image
        self._announced += 1


def said_in(text: str) -> PhoneSaid:
    """A text message, understood.

    Raises:
        Misbehaviour: it is not.
    """
    if len(text) > LARGEST_MESSAGE_BYTES:
        raise Misbehaviour(TOO_LARGE, f"messages may have at most {LARGEST_MESSAGE_BYTES} characters")
    try:
        return PhoneSaid.model_validate_json(text, strict=True)
    except ValidationError as error:
        raise Misbehaviour(REJECTED, f"not understood: {error.errors()[0]['msg']}"[:120]) from None


def hello_in(text: str) -> HelloMessage:
    """The first message.

    Raises:
        Misbehaviour: it is another one.
    """
    said = said_in(text)
    if said.hello is None:
        raise Misbehaviour(REJECTED, "the first message is hello")
    return said.hello


def _problem_of(jpeg: bytes) -> Problem | None:
    size_wh_px = jpeg_size_wh_px(jpeg)
    if size_wh_px is None:
        return broken_image()
    width, height = size_wh_px
    if min(width, height) >= MIN_SIDE_PX and width <= MAX_WIDTH_PX and height <= MAX_HEIGHT_PX:
        return None
    return Problem(
        code="PHONE_IMAGE_SIZE",
        message=f"an image of the phone has {width}x{height} px, "
        f"allowed are {MIN_SIDE_PX} to {MAX_WIDTH_PX}x{MAX_HEIGHT_PX}",
        remedy="Set camera.width and camera.height to a size that the phone's camera has.",
        context={"width_px": width, "height_px": height},
    )
