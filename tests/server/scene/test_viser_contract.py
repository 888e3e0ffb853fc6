"""Internals of viser that the scene uses. An upgrade that changes them fails here first.

In that case read viser's `_viser.py`, `infra/_infra.py` and the client's `WebsocketInterface.tsx`,
`WebsocketClientWorker.ts` and `MessageHandler.tsx` again, adapt `server/scene/door.py` and `watch.js`, run
the browser tests, and only then change the version here.

"""

import dataclasses
import inspect
import re
from pathlib import Path

import viser
import zstandard
from viser import _messages as messages
from viser import infra
from viser._scene_api import SceneApi
from viser._viser import InitialCameraConfig
from viser.infra._async_message_buffer import AsyncMessageBuffer
from viser.infra._infra import _message_producer

from server.scene.gate import SUBPROTOCOL

ALPHABET = "".join(chr(c) for c in range(0x21, 0x7F) if chr(c) not in "\"&<>'`")


def names(function: object) -> list[str]:
    return list(inspect.signature(function).parameters)  # pyrefly: ignore[bad-argument-type]  # callables only, as used below


def test_the_version_is_the_one_that_was_read() -> None:
    assert viser.__version__ == "1.1.1"
    assert SUBPROTOCOL == "viser-v1.1.1"


def test_the_pieces_of_the_server_are_called_as_before() -> None:
    assert names(SceneApi.__init__) == ["self", "owner", "thread_executor", "event_loop"]
    assert names(InitialCameraConfig.__init__) == ["self", "broadcast"]
    assert names(AsyncMessageBuffer.__init__)[:3] == ["self", "event_loop", "persistent_messages"]
    assert names(_message_producer) == ["websocket", "buffer", "client_id", "backlog_done_message"]
    assert names(infra.WebsockServer.__init__)[1:] == [
        "host", "port", "message_class", "http_server_root", "verbose", "backlog_done_message",
    ]  # fmt: skip
    assert names(viser.ViserServer._run_garbage_collector) == ["self", "force"]
    assert names(viser.ViserServer.request_share_url) == ["self", "verbose"]


def test_the_producer_needs_nothing_of_a_connection_but_send() -> None:
    source = inspect.getsource(_message_producer)
    assert set(re.findall(r"websocket\.(\w+)", source)) == {"send"}


def test_a_server_opens_its_port_only_when_it_is_started() -> None:
    assert "start(" not in inspect.getsource(infra.WebsockServer.__init__)
    assert "_incoming_handlers" in inspect.getsource(infra.WebsockServer.register_handler)


def test_the_attributes_that_viser_gives_its_server_are_those_that_the_door_gives() -> None:
    made = set(re.findall(r"self\.(_?\w+)(?:: [^=(]+)? = ", inspect.getsource(viser.ViserServer.__init__)))
    # Nothing reads _connection; gui and the share lock belong to features that are not used.
    assert made == {
        "_websock_server", "_initial_camera", "_connection", "_connected_clients", "_client_lock",
        "_scene_lifecycle_lock", "_client_connect_cb", "_client_disconnect_cb", "_thread_executor",
        "_share_tunnel", "_share_tunnel_lock", "_event_loop", "scene", "gui",
    }  # fmt: skip


def test_the_messages_have_the_fields_that_are_used() -> None:
    fields = [f.name for f in dataclasses.fields(messages.ThemeConfigurationMessage)]
    assert fields == [
        "titlebar_content", "control_layout", "control_width", "show_logo", "show_share_button",
        "dark_mode", "colors",
    ]  # fmt: skip
    assert messages.ViewerCameraMessage.__name__ == "ViewerCameraMessage"
    assert [f.name for f in dataclasses.fields(messages.ReplayDoneMessage)] == []


def test_the_client_has_the_handles_that_the_watching_script_holds() -> None:
    code = client_code()
    for handle in (
        "__viserMutable",
        "nodeRefFromName",
        "document.hasFocus()",
        "type:`retry`",
        "type:`connected`",
        "type:`message_batch`",
        "split(`?`)[0]",
    ):
        assert handle in code, handle


def test_the_client_fetches_nothing_from_outside_but_the_draco_decoder_of_models_that_are_never_sent() -> (
    None
):
    addresses = set(re.findall(r"(?:https?|wss?)://[\w.\-]+", client_code()))
    assert {a for a in addresses if "gstatic" in a} == {"https://www.gstatic.com"}
    assert not [
        a for a in addresses if "googleapis" in a or "jsdelivr" in a or "unpkg" in a or "pmnd.rs/hdri" in a
    ]


def client_code() -> str:
    """The client's code, unpacked as its loader does: base 88, then zstd."""
    html = (Path(viser.__file__).parent / "client" / "build" / "index.html").read_text(encoding="utf-8")
    found = re.search(r'data-p="([^"]+)" data-ss="(\d+)" data-cs="(\d+)"', html)
    assert found is not None
    text, packed = found[1], bytearray()
    value_from_letter = {letter: value for value, letter in enumerate(ALPHABET)}
    for start in range(0, len(text), 5):
        group = text[start : start + 5]
        number = 0
        for letter in group:
            number = number * 88 + value_from_letter[letter]
        packed += number.to_bytes(len(group) - 1, "big")
    style, code = int(found[2]), int(found[3])
    plain = zstandard.ZstdDecompressor().decompress(bytes(packed), max_output_size=style + code)
    return plain[style : style + code].decode()
