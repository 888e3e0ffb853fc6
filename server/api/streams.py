"""The addresses of the streams."""

from fastapi import APIRouter, WebSocket
from starlette.responses import Response

from server.api.errors import refusals
from server.live import LiveHub
from server.stream.errors import CameraUnknown
from server.stream.live_socket import watch_live
from server.stream.mjpeg import Video
from server.stream.view_socket import watch_view
from server.stream.viewers import Viewers

UNKNOWN_CAMERA = 1008

SOCKETS_IN_WORDS = """
`WS /ws/live`: one `LiveMessage` as JSON text for each instant, the newest at once. A slow client skips
instants (gaps in `sequence`); one that takes nothing for 2 s is cut off. The client sends nothing.

`WS /ws/view?camera=main`: the client sends `{"next": true}` and gets one binary message: 4 bytes length of
the header (unsigned, little endian), the header (a `LiveMessage` as JSON), and the JPEG of that same instant,
empty when there is no image. Then it may ask again: one image is on the way at a time.

Both are open to pages of this server and to programs that send no Origin. A client that sends anything else
is closed with code 1008 or 1009 and the reason in words.
"""


def streams_router(*, camera_name: str, video: Video, hub: LiveHub, viewers: Viewers) -> APIRouter:
    """`GET /video/{camera}.mjpg`, `WS /ws/live` and `WS /ws/view`."""
    router = APIRouter(tags=["streams"])

    @router.get(
        "/video/{camera}.mjpg",
        response_class=Response,
        responses={
            200: {
                "content": {"multipart/x-mixed-replace": {}},
                "description": "JPEG after JPEG, without end.",
            },
            **refusals(404, 422),
        },
    )
    async def video_of(camera: str) -> Response:
        """The camera's picture with the overlay burned in, as MJPEG.

        Always the newest image; a slow viewer gets fewer. When there is none, or it is too old, a picture
        that says NO VIDEO with the reason and the time, once a second. Each JPEG has a comment with
        `image_number` (null for that picture), `captured_at_s` (monotonic clock of the server) and `age_ms`
        (at sending) as JSON.
        """
        if camera != camera_name:
            raise CameraUnknown(camera, [camera_name])
        return video.response()

    @router.websocket("/ws/live")
    async def live(websocket: WebSocket) -> None:
        await watch_live(websocket, hub=hub, viewers=viewers)

    @router.websocket("/ws/view")
    async def view(websocket: WebSocket) -> None:
        asked = websocket.query_params.get("camera", camera_name)
        if asked != camera_name:
            await websocket.accept()
            await websocket.close(UNKNOWN_CAMERA, CameraUnknown(asked, [camera_name]).message[:120])
            return
        await watch_view(websocket, hub=hub, viewers=viewers)

    return router
