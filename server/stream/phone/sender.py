"""Protocol state of one sending page: round trips, camera settings, images in parts. Without I/O."""

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
    PhoneClientMessage,
    PongMessage,
)
from server.stream.phone.page_clock import PageClock
from server.stream.socket import MAX_MESSAGE_BYTES, REJECTED, TOO_LARGE, ProtocolViolation

# One in flight and one being encoded: the connection is never idle, and no more images can age.
MAX_IMAGES_IN_FLIGHT = 2
MAX_PINGS_OPEN = 64


@dataclass(frozen=True, slots=True, kw_only=True)
class Received:
    """A complete JPEG of an allowed size.

    Attributes:
        jpeg: the image.
        captured_at_s: monotonic clock of this machine, never later than the true capture.
        arrived_s: arrival of its last part.
        clock: clock of the capture time.
        camera: its camera.
    """

    jpeg: bytes
    captured_at_s: float
    arrived_s: float
    clock: ImageClock
    camera: PhoneCamera


@dataclass(frozen=True, slots=True, kw_only=True)
class CreditUpdate:
    """A ping, and the total number of images that may be sent on this connection."""

    ping: int
    credit: int


class Sender:
    """Server side of one connection, after the hello. Times are passed in."""

    def __init__(self) -> None:
        self.clock = PageClock()
        self._camera: PhoneCamera | None = None
        self._pings: dict[int, float] = {}
        self._next_ping = 0
        self._announced = 0
        self._received = 0
        self._credit = 0
        self._image: ImageMessage | None = None
        self._parts: list[bytes] = []
        self._part_bytes = 0

    def update_credit(self, now_s: float) -> CreditUpdate:
        """Return the present credit, with a new ping."""
        ping, self._next_ping = self._next_ping, self._next_ping + 1
        self._pings[ping] = now_s
        while len(self._pings) > MAX_PINGS_OPEN:
            del self._pings[next(iter(self._pings))]
        self._credit = self._received + MAX_IMAGES_IN_FLIGHT
        return CreditUpdate(ping=ping, credit=self._credit)

    def receive_text(self, text: str, now_s: float) -> None:
        """Handle one text message.

        Raises:
            ProtocolViolation: it is invalid, or out of order.
        """
        message = parse_message(text)
        if message.pong is not None:
            self._take_pong(message.pong, now_s)
        elif message.camera is not None:
            self._camera = message.camera.camera()
        elif message.image is not None:
            self._begin(message.image)
        else:
            raise ProtocolViolation(REJECTED, "hello must be sent once, as the first message")

    def take_part(self, part: bytes, now_s: float) -> Received | Problem | None:
        """Add one part of an image; return the image when complete, its problem, or None until then.

        Raises:
            ProtocolViolation: no image was announced, or it is longer than announced.
        """
        image, camera = self._image, self._camera
        if image is None or camera is None or not part:
            raise ProtocolViolation(REJECTED, "an image must be announced before its parts")
        self._parts.append(part)
        self._part_bytes += len(part)
        if self._part_bytes > image.bytes:
            raise ProtocolViolation(TOO_LARGE, f"{image.bytes} bytes were announced, {self._part_bytes} came")
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
            raise ProtocolViolation(REJECTED, f"ping {pong.ping} was already answered, or never sent")
        self.clock.take(sent_s=sent_s, page_s=pong.at_ms / 1000.0, received_s=now_s)

    def _begin(self, image: ImageMessage) -> None:
        if self._image is not None:
            raise ProtocolViolation(
                REJECTED, f"only {self._part_bytes} of {self._image.bytes} bytes of the image arrived"
            )
        if self._camera is None:
            raise ProtocolViolation(REJECTED, "the camera must be described before its first image")
        if not self.clock.is_known:
            raise ProtocolViolation(REJECTED, "a ping must be answered before the first image")
        if self._announced >= self._credit:
            raise ProtocolViolation(REJECTED, f"an image was sent beyond the credit of {self._credit} images")
        if image.bytes > MAX_JPEG_BYTES:
            raise ProtocolViolation(
                TOO_LARGE, f"the image has {image.bytes} bytes, the maximum is {MAX_JPEG_BYTES}"
            )
        self._image = image
        self._announced += 1


def parse_message(text: str) -> PhoneClientMessage:
    """Parse a text message.

    Raises:
        ProtocolViolation: it is invalid.
    """
    if len(text) > MAX_MESSAGE_BYTES:
        raise ProtocolViolation(TOO_LARGE, f"messages may have at most {MAX_MESSAGE_BYTES} characters")
    try:
        return PhoneClientMessage.model_validate_json(text, strict=True)
    except ValidationError as error:
        raise ProtocolViolation(REJECTED, f"invalid message: {error.errors()[0]['msg']}"[:120]) from None


def parse_hello(text: str) -> HelloMessage:
    """Parse the first message.

    Raises:
        ProtocolViolation: it is another one.
    """
    message = parse_message(text)
    if message.hello is None:
        raise ProtocolViolation(REJECTED, "the first message must be hello")
    return message.hello


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
        remedy="Set camera.width and camera.height to a size of the phone's camera.",
        context={
            "width_px": width,
            "height_px": height,
            "min_side_px": MIN_SIDE_PX,
            "max_width_px": MAX_WIDTH_PX,
            "max_height_px": MAX_HEIGHT_PX,
        },
    )
