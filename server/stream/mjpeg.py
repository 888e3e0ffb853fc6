"""Video for everything that shows pictures: MJPEG over plain HTTP."""

import asyncio
import contextlib
import json
import time
from collections.abc import AsyncIterator, Mapping
from datetime import datetime

from starlette.responses import Response
from starlette.types import Receive, Scope, Send

from server.live import Instant, LiveHub
from server.security import person_of
from server.stream.connection import Line, line_of
from server.stream.fitting.pictures import Pictures
from server.stream.fitting.sizes import Choice, Size
from server.stream.no_video import NoVideoCard
from server.stream.race import until_one_ends
from server.stream.viewers import Viewer, ViewerKind, Viewers

BOUNDARY = "coaxial"
MEDIA_TYPE = f"multipart/x-mixed-replace; boundary={BOUNDARY}"
PART_HEAD = f"--{BOUNDARY}\r\nContent-Type: image/jpeg\r\n\r\n".encode()
# Chrome shows a part when the next one's head has come. So that head follows each image at once, and can
# say nothing of the image to come: neither its length nor its number. Those are inside the JPEG.
PART_END = b"\r\n" + PART_HEAD
CARD_AGAIN_S = 1.0

START_OF_JFIF = b"\xff\xd8\xff\xe0"
COMMENT = b"\xff\xfe"


def with_comment(jpeg: bytes, facts: Mapping[str, object]) -> bytes:
    """The JPEG with a comment that holds these facts as JSON; the picture itself is not touched."""
    words = json.dumps(dict(facts), separators=(",", ":")).encode()
    segment = COMMENT + (len(words) + 2).to_bytes(2, "big") + words
    # JFIF wants its own segment first.
    at = 4 + int.from_bytes(jpeg[4:6], "big") if jpeg.startswith(START_OF_JFIF) else 2
    return b"".join((jpeg[:at], segment, jpeg[at:]))


class Video:
    """The pictures of the one camera, for any number of MJPEG viewers."""

    def __init__(self, *, hub: LiveHub, viewers: Viewers, pictures: Pictures, stale_after_ms: float) -> None:
        self._hub = hub
        self._viewers = viewers
        self._pictures = pictures
        self._stale_after_s = stale_after_ms / 1000.0
        self._card = NoVideoCard()

    def response(self, choice: Choice = Choice.AUTO) -> Response:
        """The answer that shows the video for as long as the viewer stays."""
        return MjpegResponse(self, self._viewers, choice)

    def missed(self, viewer: Viewer) -> int:
        """How many images came since the one that the viewer took, beside the newest."""
        newest = self._hub.newest
        return 0 if newest is None else max(0, newest.sequence - viewer.sequence - 1)

    async def pictures(self, viewer: Viewer) -> AsyncIterator[bytes]:
        """The newest picture, and again whenever there is a newer one; a card when there is none.

        What is taken is always the newest at the moment when the viewer can take it.
        """
        # Before the first instant there is nothing to wait for: say so at once.
        patience_s = self._stale_after_s if self._hub.newest is not None else 0.0
        while True:
            with contextlib.suppress(TimeoutError):
                async with asyncio.timeout(patience_s):
                    viewer.took((await self._hub.next_after(viewer.sequence)).sequence)
            instant, now_s = self._hub.newest, time.monotonic()
            if instant is not None:
                viewer.took(instant.sequence)
            if instant is not None and self._is_live(instant, now_s=now_s):
                patience_s = self._stale_after_s
                size = viewer.pace.size
                jpeg = await self._pictures.of(instant, size)
                yield _with_facts(instant, jpeg, size)
            else:
                patience_s = CARD_AGAIN_S
                clock = datetime.now().astimezone()
                card = self._card.jpeg(instant, now_s=now_s, clock=clock)
                yield with_comment(card, {"image_number": None})

    def _is_live(self, instant: Instant, *, now_s: float) -> bool:
        snapshot = instant.snapshot
        return (
            snapshot is not None
            and instant.has_picture
            and now_s - snapshot.captured_at_s <= self._stale_after_s
        )


def _with_facts(instant: Instant, jpeg: bytes, size: Size) -> bytes:
    if instant.snapshot is None or not jpeg:
        return jpeg
    number, captured_at_s = instant.snapshot.image_number, instant.snapshot.captured_at_s
    facts = {
        "image_number": number,
        "captured_at_s": round(captured_at_s, 6),
        "age_ms": round((time.monotonic() - captured_at_s) * 1000.0, 1),
        "shown_scale_ratio": size.scale_ratio,
    }
    return with_comment(jpeg, facts)


class MjpegResponse(Response):
    """An answer of pictures without end; a viewer that is stalled or gone ends it."""

    media_type = MEDIA_TYPE

    def __init__(self, video: Video, viewers: Viewers, choice: Choice) -> None:
        self.status_code = 200
        self.background = None
        self.body = b""
        self.init_headers(
            {"Cache-Control": "no-store, no-transform", "X-Accel-Buffering": "no", "Pragma": "no-cache"}
        )
        del self.headers["content-length"]
        self._video = video
        self._viewers = viewers
        self._choice = choice

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Send until the viewer goes, or until nothing could be sent for too long.

        Raises:
            TooManyViewers: as many watch as are allowed; the answer has not begun then.
        """
        line = line_of(scope)
        with self._viewers.watching(ViewerKind.MJPEG, self._choice, person=person_of(scope)) as viewer:
            if line is not None:
                line.is_endless = True
            try:
                await until_one_ends(self._feed(send, line, viewer), _until_gone(receive))
            finally:
                if line is not None:
                    line.cut()

    async def _feed(self, send: Send, line: Line | None, viewer: Viewer) -> None:
        start = {"type": "http.response.start", "status": 200, "headers": self.raw_headers}
        await self._viewers.send(send(start), line)
        await self._viewers.send(send(_body(PART_HEAD)), line)
        async for picture in self._video.pictures(viewer):
            began_s = time.monotonic()
            await self._viewers.send(send(_body(picture + PART_END)), line)
            viewer.pace.sent(began_s=began_s, ended_s=time.monotonic(), missed=self._video.missed(viewer))


def _body(content: bytes) -> dict[str, object]:
    return {"type": "http.response.body", "body": content, "more_body": True}


async def _until_gone(receive: Receive) -> None:
    while (await receive())["type"] != "http.disconnect":
        pass
