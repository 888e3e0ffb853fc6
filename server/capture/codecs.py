"""OpenCV video capture, silent and with timeouts."""

import contextlib
import os
import sys
from collections.abc import Iterator

import cv2

OPTIONS_VARIABLE = "OPENCV_FFMPEG_CAPTURE_OPTIONS"
OPEN_TIMEOUT_MS = 3000
READ_TIMEOUT_MS = 2000
# Intra-only codecs by their OpenCV names in capitals; uncompressed video has no name.
INTRA_CODECS = {"", "MJPG", "LJPG", "MJP2", "MPNG", "FFV1", "FFVH", "HFYU", "MAGY", "V210", "AVDN", "DVSD"}
INTRA_CODECS |= {
    "APCH",
    "APCN",
    "APCO",
    "APCS",
    "AP4H",
    "AP4X",
    "ULH0",
    "ULRA",
    "ULRG",
    "ULY0",
    "ULY2",
    "ULY4",
}
# TCP, because a lost UDP packet corrupts half an image; no buffer and short probing, because an old image is
# worse than none; one decoding thread, because each further one delays by an image. No audio, because with it
# FFmpeg shifts all timestamps by the sender reports, and they jump at the first of these.
STREAM_OPTIONS = (
    "rtsp_transport;tcp|allowed_media_types;video|fflags;nobuffer|flags;low_delay|analyzeduration;200000|"
    "fpsprobesize;0"
)


def silence_codecs() -> None:
    """Keep OpenCV, FFmpeg and V4L from writing to the terminal; relevant errors become a CaptureError."""
    os.environ.setdefault("OPENCV_FFMPEG_LOGLEVEL", "-8")
    os.environ.setdefault("OPENCV_VIDEOIO_V4L_SELECT_TIMEOUT", "2")
    cv2.utils.logging.setLogLevel(cv2.utils.logging.LOG_LEVEL_SILENT)


def open_file(path: str) -> cv2.VideoCapture:
    """Open a video file; check `isOpened`."""
    silence_codecs()
    return cv2.VideoCapture(path, cv2.CAP_FFMPEG)


def open_stream(address: str) -> cv2.VideoCapture:
    """Open a network stream with a timeout of 3 s, and of 2 s for each read; check `isOpened`."""
    silence_codecs()
    limits = [
        cv2.CAP_PROP_OPEN_TIMEOUT_MSEC,
        OPEN_TIMEOUT_MS,
        cv2.CAP_PROP_READ_TIMEOUT_MSEC,
        READ_TIMEOUT_MS,
        cv2.CAP_PROP_N_THREADS,
        1,
    ]
    with _stream_options():
        return cv2.VideoCapture(address, cv2.CAP_FFMPEG, limits)


def is_predicted(video: cv2.VideoCapture) -> bool:
    """Return whether the codec of an open file or stream predicts images from earlier ones, as H.264 does.

    True for an unknown codec, because an error stated too large is safer than one stated too small.
    """
    fourcc = int(video.get(cv2.CAP_PROP_FOURCC))
    name = "".join(chr((fourcc >> shift) & 0xFF) for shift in (0, 8, 16, 24))
    return name.strip("\0 ").upper() not in INTRA_CODECS


def set_jpeg_packets(video: cv2.VideoCapture) -> bool:
    """Make an open MJPEG file or stream return its packets instead of images; False for another codec.

    FFmpeg decodes damaged JPEGs without a word, and OpenCV scales all images to the size of the first.
    """
    is_jpeg = int(video.get(cv2.CAP_PROP_FOURCC)) == cv2.VideoWriter.fourcc(*"MJPG")
    return is_jpeg and bool(video.set(cv2.CAP_PROP_FORMAT, -1))


@contextlib.contextmanager
def _stream_options() -> Iterator[None]:
    """Set OpenCV's environment options for a stream; restored, because they cost a file its first image."""
    given = os.environ.get(OPTIONS_VARIABLE)
    os.environ[OPTIONS_VARIABLE] = given or STREAM_OPTIONS
    try:
        yield
    finally:
        if given is None:
            del os.environ[OPTIONS_VARIABLE]


def open_device(device: str) -> cv2.VideoCapture:
    """Open a local camera by number or path, with as few buffers as its rate allows; check `isOpened`."""
    silence_codecs()
    backend = cv2.CAP_V4L2 if sys.platform == "linux" else cv2.CAP_ANY
    camera = cv2.VideoCapture(int(device) if device.isdecimal() else device, backend)
    # With a single buffer every second image is lost, because none is free while an image is decoded.
    camera.set(cv2.CAP_PROP_BUFFERSIZE, 2)
    return camera
