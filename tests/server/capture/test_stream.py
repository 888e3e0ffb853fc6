"""Network streams, with a small MJPEG server that is stopped and restarted."""

import itertools
import socket
import threading
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler
from pathlib import Path

import cv2
import pytest

from server.capture.address import source_from_text
from server.capture.capture import Capture
from server.capture.stream import StreamSource
from server.capture.video_file import VideoFileSource
from server.errors import CaptureError
from server.live import SourceState
from tests.server.capture.http_image_server import ImageServer
from tests.server.capture.small_videos import grey_image, write_video


@pytest.fixture
def stop() -> Iterator[threading.Event]:
    event = threading.Event()
    yield event
    event.set()


class MjpegServer(ImageServer):
    def __init__(self, port: int = 0) -> None:
        super().__init__(_Handler, port)


class _Handler(BaseHTTPRequestHandler):
    def log_message(self, format: str, *args: object) -> None:  # noqa: A002  the base's name
        del format, args

    def do_GET(self) -> None:
        server = self.server
        assert isinstance(server, MjpegServer)
        # An unchanging image would count as a frozen camera.
        contents = [cv2.imencode(".jpg", grey_image(grey))[1].tobytes() for grey in (99, 101)]
        head = b"--x\r\nContent-Type: image/jpeg\r\nContent-Length: %d\r\n\r\n"
        self.send_response(200)
        self.send_header("Content-Type", "multipart/x-mixed-replace; boundary=x")
        self.end_headers()
        try:
            for content in itertools.cycle(contents):
                if server.ended.wait(0.03):
                    break
                self.wfile.write(head % len(content) + content + b"\r\n")
        except OSError:
            pass


@pytest.fixture
def server() -> Iterator[MjpegServer]:
    made = MjpegServer()
    yield made
    if not made.ended.is_set():
        made.end()


def stream_of(port: int, stop: threading.Event) -> StreamSource:
    return StreamSource(source_from_text(f"http://user:secret@127.0.0.1:{port}/live.mjpg"), stop=stop)


def test_a_stream_gives_images_and_reconnects_when_its_server_is_back(
    server: MjpegServer, stop: threading.Event
) -> None:
    port = server.server_address[1]
    capture = Capture(stream_of(port, stop), stop=stop)
    capture.start()
    first = capture.take(30.0)
    assert first is not None
    assert float(first.image.mean()) == pytest.approx(100, abs=2)
    server.end()
    while capture.status().state is not SourceState.RECONNECTING:
        capture.take(10.0)
    problem = capture.status().problem
    assert problem is not None
    assert problem.code in {"STREAM_STOPPED", "STREAM_UNREACHABLE", "STREAM_WITHOUT_VIDEO"}
    assert "secret" not in problem.message
    assert problem.remedy
    again = MjpegServer(port)
    try:
        shot = None
        while shot is None:
            shot = capture.take(10.0)
        assert shot.number > first.number
        assert capture.status().state is SourceState.RUNNING
        assert capture.status().problem is None
    finally:
        stop.set()
        capture.close(5.0)
        again.end()


def test_nobody_there_is_reported_at_once_with_host_and_port(stop: threading.Event) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))  # bound, not listening: rejected
        port = taken.getsockname()[1]
        with pytest.raises(CaptureError) as caught:
            stream_of(port, stop).open()
    assert caught.value.code == "STREAM_UNREACHABLE"
    assert f"127.0.0.1:{port}" in caught.value.message
    assert "secret" not in str(caught.value)


def test_a_host_that_answers_without_video_is_given_up_by_itself(stop: threading.Event) -> None:
    with socket.socket() as mute:
        mute.bind(("127.0.0.1", 0))
        mute.listen(8)
        with pytest.raises(CaptureError) as caught:
            stream_of(mute.getsockname()[1], stop).open()
    assert caught.value.code == "STREAM_WITHOUT_VIDEO"


def test_an_address_that_cannot_be_is_reported(stop: threading.Event) -> None:
    source = StreamSource(source_from_text("rtsp://me:secret/more@camera:554/x"), stop=stop)
    with pytest.raises(CaptureError) as caught:
        source.open()
    assert caught.value.code == "STREAM_ADDRESS_INVALID"
    # In place of the port there is the beginning of the password.
    assert "secret" not in str(caught.value)
    assert caught.value.__cause__ is None


def test_a_file_keeps_its_first_image_after_a_stream_was_open(
    server: MjpegServer, stop: threading.Event, tmp_path: Path
) -> None:
    stream = stream_of(server.server_address[1], stop)
    stream.open()
    stream.close()
    video = VideoFileSource(write_video(tmp_path / "v.avi", images=3), loop=False, pacer=None)
    video.open()
    times_s = [shot.source_time_s for shot in iter(video.read, None) if shot]
    assert times_s == pytest.approx([0.0, 0.04, 0.08])
