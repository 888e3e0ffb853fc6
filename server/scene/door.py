"""viser without a port, a thread or message handlers.

`viser.ViserServer` opens a port on construction, registers handlers for a public share tunnel and for its
graphical controls, and prints. `Door` builds the same object without these: a scene whose changes are stored
in viser's buffer, and a coroutine that sends them to one viewer. It runs in the event loop of the
application, so that the changes of one image are never split.

Private names of viser are used only here; `tests/server/scene/test_viser_contract.py` verifies them.
"""

import asyncio
import itertools
import threading
from collections.abc import Awaitable, Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any, cast

import viser
from viser import _messages as messages
from viser import infra
from viser._scene_api import SceneApi
from viser._viser import InitialCameraConfig
from viser.infra._async_message_buffer import AsyncMessageBuffer
from viser.infra._infra import _message_producer

Send = Callable[[bytes], Awaitable[None]]


class _Line:
    """Connection with the only method that viser's producer calls."""

    def __init__(self, send: Send) -> None:
        self.send = send


class Door(viser.ViserServer):
    """The part of viser's server that the scene needs. Create it in the running event loop."""

    def __init__(self) -> None:
        # super().__init__() is not called, because it opens a port on all interfaces and registers a tunnel.
        loop = asyncio.get_running_loop()
        server = infra.WebsockServer(
            host="", port=0, message_class=messages.Message, verbose=False, backlog_done_message=None
        )
        server._broadcast_buffer = AsyncMessageBuffer(loop, persistent_messages=True)  # noqa: SLF001 held by the contract test
        self._websock_server = server
        self._initial_camera = InitialCameraConfig(broadcast=server.queue_message)
        self._connected_clients = {}
        self._client_lock = threading.Lock()
        self._scene_lifecycle_lock = threading.RLock()
        self._thread_executor = ThreadPoolExecutor(max_workers=1, thread_name_prefix="viser")
        self._share_tunnel = None
        self._event_loop = loop
        self._viewer_ids = itertools.count()
        self.scene = SceneApi(self, thread_executor=self._thread_executor, event_loop=loop)
        # Handlers of clicks, drags and gizmos, removed so that no message can reach them.
        server._incoming_handlers.clear()  # noqa: SLF001 held by the contract test
        server.queue_message(
            messages.ThemeConfigurationMessage(
                titlebar_content=None,
                control_layout="floating",
                control_width="small",
                show_logo=False,
                show_share_button=False,
                dark_mode=True,
                colors=None,
            )
        )

    async def serve(self, send: Send) -> None:
        """Send the whole scene to one viewer and then each change, until `send` raises or `stop` is called.

        A slow viewer skips changes: only the newest value of each pose is stored, once for all viewers.
        """
        # Removed nodes need not be sent to a new viewer.
        self._run_garbage_collector()
        await _message_producer(
            cast(Any, _Line(send)),
            self._websock_server._broadcast_buffer,  # noqa: SLF001 held by the contract test
            next(self._viewer_ids),
            backlog_done_message=messages.ReplayDoneMessage(),
        )

    def stop(self) -> None:
        """End all connections."""
        self._websock_server._broadcast_buffer.set_done()  # noqa: SLF001 held by the contract test
        self._thread_executor.shutdown(wait=False)

    def request_share_url(self, verbose: bool = True) -> str | None:
        """Raise PermissionError, because the scene must not be shown through a public tunnel."""
        del verbose
        raise PermissionError("the scene has no share tunnel")
