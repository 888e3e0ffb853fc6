"""A network camera with wrong size, time and rate: no old image counts as live, and none is stretched."""

import contextlib
import itertools
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from http.server import BaseHTTPRequestHandler

import cv2
import numpy as np
import pytest

from server.capture.address import source_from_text
from server.capture.capture import Capture
from server.capture.shot import Shot
from server.capture.stream import StreamSource
from server.errors import CaptureError
from server.live import ImageClock, SourceState
from tests.server.capture.http_image_server import ImageServer
from tests.server.capture.small_videos import grey_image

VGA, QVGA, WIDE = (640, 480), (320, 240), (640, 360)
PERIOD_S = 1 / 30
# Images sent beyond those that a test reads: the decoder looks ahead.
AHEAD = 12


@dataclass(frozen=True, slots=True, kw_only=True)
class Sent:
    """One image as sent: grey level, size, sent share, lost bytes, and stated length."""

    grey: int
    size_wh_px: tuple[int, int] = VGA
    content_ratio: float = 1.0
    lost_bytes: int = 0
    claimed_ratio: float = 1.0

    @property
    def part(self) -> bytes:
        content = cv2.imencode(".jpg", grey_image(self.grey, self.size_wh_px))[1].tobytes()
        content = content[: int(len(content) * self.content_ratio)]
        content = content[: len(content) // 2] + content[len(content) // 2 + self.lost_bytes :]
        head = b"--x\r\nContent-Type: image/jpeg\r\nContent-Length: %d\r\n\r\n"
        return head % int(len(content) * self.claimed_ratio) + content + b"\r\n"


class LyingServer(ImageServer):
    """Sends its images at once to each client, and then nothing."""

    def __init__(self, images: Sequence[Sent]) -> None:
        self.parts = [image.part for image in images]
        super().__init__(_Handler)


class _Handler(BaseHTTPRequestHandler):
    def log_message(self, format: str, *args: object) -> None:  # noqa: A002  the base's name
        del format, args

    def do_GET(self) -> None:
        server = self.server
        assert isinstance(server, LyingServer)
        self.send_response(200)
        self.send_header("Content-Type", "multipart/x-mixed-replace; boundary=x")
        self.end_headers()
        try:
            for part in server.parts:
                self.wfile.write(part)
            server.ended.wait()
        except OSError:
            pass


@pytest.fixture
def serve() -> Iterator[Callable[[Sequence[Sent]], LyingServer]]:
    servers: list[LyingServer] = []

    def made(images: Sequence[Sent]) -> LyingServer:
        servers.append(LyingServer(images))
        return servers[-1]

    yield made
    for server in servers:
        server.end()


def source_of(server: LyingServer, intervals_s: Sequence[float], *, begin_s: float = 100.0) -> StreamSource:
    """Images arrive after these intervals on the test's clock, then every 33 ms."""
    times_s = itertools.accumulate(itertools.chain(intervals_s, itertools.repeat(PERIOD_S)), initial=begin_s)
    return StreamSource(
        source_from_text(f"http://127.0.0.1:{server.server_address[1]}/live.mjpg"),
        stop=threading.Event(),
        clock=lambda: next(times_s),
    )


def read(source: StreamSource, images: int) -> list[Shot]:
    source.open()
    shots = [source.read() for _ in range(images)]
    source.close()
    return [shot for shot in shots if shot is not None]


def code_after(source: StreamSource, images: int) -> str:
    """Code of the error that ends the stream within this many images; empty if none does."""
    try:
        for _ in range(images):
            source.read()
    except CaptureError as error:
        return error.code
    finally:
        source.close()
    return ""


def grey_of(shot: Shot) -> int:
    return round(float(np.mean(shot.image)))


def test_each_image_has_the_size_that_it_was_sent_with(
    serve: Callable[[Sequence[Sent]], LyingServer],
) -> None:
    sizes = [*[VGA] * 8, *[QVGA] * 8, *[WIDE] * 8, *[VGA] * (8 + AHEAD)]
    sent = [Sent(grey=40 + 4 * number, size_wh_px=size) for number, size in enumerate(sizes)]
    shots = read(source_of(serve(sent), []), 28)
    assert {shot.image.shape[1::-1] for shot in shots} == {VGA, QVGA, WIDE}
    for shot in shots:
        number = round((grey_of(shot) - 40) / 4)
        assert shot.image.shape[1::-1] == sizes[number], number


def test_what_was_held_back_during_a_stall_is_not_shown(
    serve: Callable[[Sequence[Sent]], LyingServer],
) -> None:
    sent = [Sent(grey=40 + 2 * number) for number in range(60 + AHEAD)]
    # Twenty in rhythm, a second of silence, the held-back images at once, then the rhythm again.
    intervals_s = [*[PERIOD_S] * 19, 1.0, *[0.001] * 15]
    shots = read(source_of(serve(sent), intervals_s), 30)
    assert [shot.number for shot in shots] == [*range(1, 20), *range(36, 47)]
    assert shots[19].captured_at_s == pytest.approx(100.0 + 19 * PERIOD_S + 1.015 + PERIOD_S)


def test_a_stream_that_always_comes_in_bursts_is_reported(
    serve: Callable[[Sequence[Sent]], LyingServer],
) -> None:
    sent = [Sent(grey=40 + number) for number in range(100 + AHEAD)]
    source = source_of(serve(sent), [*[PERIOD_S] * 9, *[0.5, *[0.001] * 9] * 8])
    source.open()
    for _ in range(9):
        source.read()
    with pytest.raises(CaptureError) as caught:
        source.read()
    source.close()
    assert caught.value.code == "STREAM_IN_BURSTS"
    assert "2 s" in caught.value.message


@pytest.mark.parametrize(
    ("content_ratio", "lost_bytes"), [(0.5, 0), (1.0, 300)], ids=["cut-off", "with-a-gap"]
)
def test_damaged_images_are_left_out_and_counted_and_when_all_are_it_is_reported(
    serve: Callable[[Sequence[Sent]], LyingServer], content_ratio: float, lost_bytes: int
) -> None:
    sent = [
        Sent(grey=40 + 4 * n)
        if n % 3 != 2
        else Sent(grey=40 + 4 * n, content_ratio=content_ratio, lost_bytes=lost_bytes)
        for n in range(36 + AHEAD)
    ]
    source = source_of(serve(sent), [])
    shots = read(source, 20)
    assert all((grey_of(shot) - 40) // 4 % 3 != 2 for shot in shots)
    assert source.defect is not None
    assert source.defect.code == "IMAGES_DAMAGED"
    all_damaged = [
        *[Sent(grey=90) for _ in range(8)],
        *[Sent(grey=100 + n, content_ratio=content_ratio, lost_bytes=lost_bytes) for n in range(50 + AHEAD)],
    ]
    source = source_of(serve(all_damaged), [])
    source.open()
    assert code_after(source, 20) == "IMAGES_DAMAGED"


@pytest.mark.parametrize("claimed_ratio", [0.3, 3.0])
def test_a_false_length_makes_no_false_image(
    serve: Callable[[Sequence[Sent]], LyingServer], claimed_ratio: float
) -> None:
    sent = [
        Sent(grey=60 + number, claimed_ratio=claimed_ratio if number % 4 == 3 else 1.0)
        for number in range(80 + AHEAD)
    ]
    source = source_of(serve(sent), [])
    source.open()
    shots: list[Shot] = []
    # The decoder may lose synchronisation: the stream then ends and is reopened.
    with contextlib.suppress(CaptureError):
        shots += (shot for _ in range(12) if (shot := source.read()) is not None)
    source.close()
    for shot in shots:
        assert shot.image.shape == (480, 640, 3)
        assert float(np.std(shot.image)) < 1.0


def test_a_stream_that_repeats_its_last_image_is_frozen(
    serve: Callable[[Sequence[Sent]], LyingServer],
) -> None:
    sent = [*[Sent(grey=40 + 5 * number) for number in range(20)], *[Sent(grey=200)] * 200]
    stop = threading.Event()
    source = source_of(serve(sent), [], begin_s=time.monotonic())
    capture = Capture(source, stop=stop)
    capture.start()
    problem = None
    while problem is None:
        capture.take(30.0)
        problem = capture.status().problem
    status = capture.status()
    stop.set()
    capture.close(5.0)
    assert problem.code == "SOURCE_FROZEN"
    assert status.state is SourceState.RECONNECTING
    # A quarter of a second of it, until it is known to be unchanged.
    assert status.images <= 20 + 9
    assert status.camera is not None
    assert status.camera.clock is ImageClock.ARRIVAL
