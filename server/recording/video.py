"""Export of a recording as a video (MP4, VP9) with the overlay of each image.

`server.overlay` draws the recorded results; nothing is recomputed. Images keep their capture times, so that
the rate varies as recorded. Images whose results cannot be drawn are marked. After
`limits.video_stale_after_ms` without an image the video shows a card instead of the last image and its old
figures.

PyAV is an optional dependency, because its wheels contain x264 and x265, which are under the GPL. Neither is
used.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from datetime import UTC, datetime
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING

import cv2
import numpy as np
from pydantic import ValidationError

from server.clock import utc_text
from server.disk import named_when_complete
from server.errors import RecordingError
from server.loop.tracking_state import TrackingState
from server.overlay import draw_card, draw_overlay, with_strip
from server.recording.recorded_results import alarms_of, snapshot_in_state, state_of
from server.recording.timeline import STATE_ENDS, RecordingIndex, Report, make_index, stored_index
from server.recording_file import RecordedMessage, RecordingReader, Topic, rejecting_other_content
from server.recording_file.locations import read_content
from server.recording_file.packing import Image
from server.stream.alarm_messages import AlarmsMessage
from server.stream.snapshot_messages import SnapshotMessage
from server.texts import Language, Text
from server.texts.language import number_text
from tracker.errors import InvalidInput
from tracker.navigation.alarms import QUIET

if TYPE_CHECKING:
    from av.container import OutputContainer
    from av.video.stream import VideoStream

CODEC = "libvpx-vp9"
# Constant quality; encodes about 60 images of 1280x720 per second on one core.
OPTIONS = {"deadline": "realtime", "cpu-used": "8", "row-mt": "1", "crf": "30", "b": "0"}
TIME_BASE = Fraction(1, 90_000)
MAX_GAP_S = 0.5
BT_709 = 1

NO_SETUP: Text = {
    "en": "RESULTS NOT DRAWN · setup missing in the recording",
    "de": "ERGEBNISSE NICHT DARGESTELLT · Aufbau fehlt in der Aufzeichnung",
}
OTHER_VERSION: Text = {
    "en": "RESULTS NOT DRAWN · recorded by another version",
    "de": "ERGEBNISSE NICHT DARGESTELLT · von einer anderen Version aufgezeichnet",
}
NO_ALARMS: Text = {"en": "ALARMS NOT RECORDED", "de": "ALARME NICHT AUFGEZEICHNET"}
NOT_DECODED: Text = {"en": "IMAGE DAMAGED", "de": "BILD BESCHÄDIGT"}
NO_IMAGE: Text = {"en": "NO IMAGE", "de": "KEIN BILD"}
GAP: Text = {"en": "No image for {} s.", "de": "{} s lang kein Bild."}
IMAGE: Text = {"en": "image", "de": "Bild"}


@dataclass(frozen=True, slots=True, kw_only=True)
class VideoSummary:
    """Summary of a video.

    Attributes:
        images: Number of recorded images in the video.
        gaps: Number of cards, one for each period without an image.
        images_without_overlay: Number of images whose results could not be drawn.
        is_whole: Whether the recording is complete.
        incomplete_reason: Why it is not.
    """

    images: int
    gaps: int
    images_without_overlay: int
    is_whole: bool
    incomplete_reason: str = ""


def write_video(
    recording: Path,
    target: Path,
    *,
    language: Language = "en",
    report: Report = lambda _ratio, _doing: None,
) -> VideoSummary:
    """Write a recording as a video, up to the end of an incomplete file.

    Args:
        recording: File of the recording.
        target: File of the video; overwritten when the video is complete.
        language: Language of the text.
        report: Called with the completed share (0 to 1) and the present activity.

    Raises:
        RecordingError: VIDEO_ENCODER_MISSING, VIDEO_NOT_WRITTEN, RECORDING_NOT_READABLE, RECORDING_EMPTY.
    """
    _require_encoder()
    index = stored_index(recording) or make_index(recording)
    if not len(index):
        raise RecordingError(
            "RECORDING_EMPTY",
            f"{recording.name} has no image",
            "Choose a recording with images.",
            {"name": recording.name},
        )
    pictures = _Pictures(recording, index, language)
    images = gaps = 0
    try:
        with named_when_complete(target) as unfinished, _Encoder(unfinished) as encoder:
            for picture in pictures:
                encoder.add(picture.image, picture.at_s)
                images, gaps = images + (not picture.is_gap), gaps + picture.is_gap
                report(images / len(index), "writing the video")
    except OSError as error:
        raise _not_written(target, error) from error
    return VideoSummary(
        images=images,
        gaps=gaps,
        images_without_overlay=pictures.images_without_overlay,
        is_whole=pictures.is_whole,
        incomplete_reason=pictures.incomplete_reason,
    )


def _require_encoder() -> None:
    why = "they are written with PyAV, which is not installed"
    try:
        import av  # noqa: PLC0415  optional
    except ImportError:
        has_encoder = False
    else:
        has_encoder = CODEC in av.codecs_available
        why = f"the FFmpeg of the installed PyAV lacks {CODEC}"
    if not has_encoder:
        raise RecordingError(
            "VIDEO_ENCODER_MISSING",
            f"videos cannot be written: {why}",
            'Install it into the environment of Coaxial: pip install "coaxial[video]", or pip install av.',
            {"encoder_problem": why},
        )


@dataclass(frozen=True, slots=True)
class _Picture:
    image: Image
    at_s: float
    is_gap: bool = False


class _Pictures:
    """Pictures of a video in order."""

    def __init__(self, path: Path, index: RecordingIndex, language: Language) -> None:
        self.images_without_overlay = 0
        self.is_whole, self.incomplete_reason = False, ""
        self._path, self._index, self._language = path, index, language
        self._max_gap_s = MAX_GAP_S
        self._state: TrackingState | None = None

    def __iter__(self) -> Iterator[_Picture]:
        reader = RecordingReader(self._path)
        image: RecordedMessage | None = None
        number, before_s = 0, 0.0
        size_wh_px = (0, 0)
        for message in reader.messages():
            match message.topic:
                case Topic.SESSION:
                    with rejecting_other_content(self._path):
                        limits = message.json().get("settings", {}).get("limits", {})
                        self._max_gap_s = limits.get("video_stale_after_ms", 1e3 * MAX_GAP_S) / 1e3
                case Topic.STATE:
                    self._state = state_of(message.content)
                case Topic.NOTE:
                    with rejecting_other_content(self._path):
                        if message.json()["code"] in STATE_ENDS:
                            self._state = None
                case Topic.IMAGE:
                    image = message
                case Topic.SNAPSHOT if image is not None and image.sequence == message.sequence:
                    if number >= len(self._index):
                        break
                    at_s = float(self._index.at_s[number])
                    if number and at_s - before_s > self._max_gap_s:
                        yield self._card(size_wh_px, before_s, at_s)
                    if image.packed is not None:
                        size_wh_px = image.packed.size_wh_px
                    yield self._picture(number, at_s, size_wh_px, image, message)
                    image, before_s, number = None, at_s, number + 1
                case _:
                    pass  # no part of a picture
        self.is_whole, self.incomplete_reason = reader.is_whole, reader.incomplete_reason

    def _picture(
        self,
        number: int,
        at_s: float,
        size_wh_px: tuple[int, int],
        image: RecordedMessage,
        snapshot: RecordedMessage,
    ) -> _Picture:
        pixels, note = image.image, ""
        if pixels is None:
            width, height = size_wh_px
            pixels, note = np.zeros((height, width, 3), dtype=np.uint8), NOT_DECODED[self._language]
        else:
            pixels, note = self._drawn(number, pixels, snapshot)
        self.images_without_overlay += bool(note) and note != NO_ALARMS[self._language]
        place = f"{IMAGE[self._language]} {image.sequence}, {number + 1} / {len(self._index)}"
        words = f"{self._time(at_s)} · {place}"
        return _Picture(with_strip(pixels, words, note=note, language=self._language), at_s)

    def _drawn(self, number: int, pixels: Image, snapshot: RecordedMessage) -> tuple[Image, str]:
        """Return the image with its results, and a note on what is missing from it."""
        language = self._language
        try:
            message = SnapshotMessage.model_validate_json(snapshot.content)
            content = self._alarms(number)
            alarms = alarms_of(AlarmsMessage.model_validate_json(content)) if content else QUIET
        except ValidationError:
            return pixels, OTHER_VERSION[language]
        recorded = snapshot_in_state(message, self._state)
        if recorded is None:
            return pixels, NO_SETUP[language]
        try:
            drawn = draw_overlay(pixels, recorded, alarms, language=language)
        except InvalidInput:
            return pixels, NOT_DECODED[language]
        return drawn, "" if content else NO_ALARMS[language]

    def _alarms(self, number: int) -> bytes:
        offset, length = (int(one) for one in self._index.alarms[number])
        if not length:
            return b""
        with self._path.open("rb") as file:
            return read_content(file, offset, length)

    def _card(self, size_wh_px: tuple[int, int], before_s: float, next_s: float) -> _Picture:
        """Return the card shown from the time at which the last image is too old until the next image."""
        at_s = before_s + self._max_gap_s
        lasted = GAP[self._language].format(number_text(next_s - before_s, self._language))
        card = draw_card(size_wh_px=size_wh_px, title=NO_IMAGE[self._language], lines=(lasted,))
        return _Picture(with_strip(card, self._time(at_s), language=self._language), at_s, is_gap=True)

    def _time(self, at_s: float) -> str:
        """Return an instant as time of day in ms, and as time since the first image."""
        time = utc_text(datetime.fromtimestamp(self._index.begin_unix_s + at_s, tz=UTC))
        minutes, seconds = divmod(at_s, 60.0)
        return f"{time.replace('T', ' ').replace('Z', ' UTC')} · {int(minutes)}:{seconds:06.3f}"


class _Encoder:
    """Encodes pictures at their times; all pictures are fitted into the size of the first one.

    Raises:
        OSError: The file cannot be written.
    """

    def __init__(self, target: Path) -> None:
        self._target = target
        self._container: OutputContainer | None = None
        self._stream: VideoStream | None = None
        self._pts = -1

    def __enter__(self) -> "_Encoder":
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        if self._container is None:
            return
        try:
            if kind is None and self._stream is not None:
                self._container.mux(self._stream.encode(None))
        finally:
            self._container.close()

    def add(self, image: Image, at_s: float) -> None:
        """Encode a picture that is shown from `at_s` on."""
        import av  # noqa: PLC0415  optional

        if self._container is None or self._stream is None:
            self._container, self._stream = _opened(self._target, image)
        size_wh_px = (self._stream.width, self._stream.height)
        frame = av.VideoFrame.from_ndarray(_fitted(image, size_wh_px), format="bgr24")
        frame = frame.reformat(format="yuv420p", dst_colorspace="ITU709")
        # Must increase strictly, but two images may fall within one tick.
        self._pts = max(round(at_s / TIME_BASE), self._pts + 1)
        frame.pts, frame.time_base = self._pts, TIME_BASE
        self._container.mux(self._stream.encode(frame))


def _opened(target: Path, image: Image) -> "tuple[OutputContainer, VideoStream]":
    import av  # noqa: PLC0415  optional

    container = av.open(str(target), "w", format="mp4", options={"movflags": "faststart"})
    stream = container.add_stream(CODEC, rate=30, options=OPTIONS)
    height, width = image.shape[:2]
    # Chroma has half the resolution, so that the size must be even.
    stream.width, stream.height = width + width % 2, height + height % 2
    stream.pix_fmt = "yuv420p"
    stream.time_base = stream.codec_context.time_base = TIME_BASE
    context = stream.codec_context
    context.colorspace = context.color_primaries = context.color_trc = BT_709
    container.metadata["title"] = "Recording of Coaxial, not live"
    return container, stream


def _fitted(image: Image, size_wh_px: tuple[int, int]) -> Image:
    """Return the image in this size, with black at the right or lower edge if the aspect ratio differs."""
    width, height = size_wh_px
    ratio = min(width / image.shape[1], height / image.shape[0])
    if ratio < 1.0 or ratio > 1.01:
        image = np.asarray(
            cv2.resize(image, None, fx=ratio, fy=ratio, interpolation=cv2.INTER_AREA), np.uint8
        )
    below, beside = height - image.shape[0], width - image.shape[1]
    if not (below or beside):
        return image
    return np.asarray(cv2.copyMakeBorder(image, 0, below, 0, beside, cv2.BORDER_CONSTANT), np.uint8)


def _not_written(target: Path, error: OSError) -> RecordingError:
    what = (error.strerror or str(error)).lower()
    return RecordingError(
        "VIDEO_NOT_WRITTEN",
        f"the video {target.name} cannot be written: {what}",
        "Check that its folder exists and its disk has free space, then export again.",
        {"name": target.name, "system_error": what},
    )
