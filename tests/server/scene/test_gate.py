"""Messages that a viewer may send."""

import msgspec
import pytest

from server.scene.gate import BURST, LARGEST_MESSAGE_BYTES, Gate, Verdict


def message(kind: str, **fields: object) -> bytes:
    return msgspec.msgpack.encode({"type": kind, **fields})


@pytest.mark.parametrize(
    ("sent", "verdict"),
    [
        pytest.param(message("ViewerCameraMessage", fov=1.0), Verdict.CAMERA, id="a turned view"),
        pytest.param(message("ShareUrlRequest"), Verdict.UNWANTED, id="a share tunnel asked for"),
        pytest.param(message("ShareUrlDisconnect"), Verdict.UNWANTED, id="a share tunnel closed"),
        pytest.param(message("GuiUpdateMessage", uuid="x", updates={}), Verdict.UNWANTED, id="a control set"),
        pytest.param(message("GuiFormDirtyMessage", uuid="x"), Verdict.UNWANTED, id="memory to grow"),
        pytest.param(
            message("TransformControlsUpdateMessage", name="/x"), Verdict.UNWANTED, id="a gizmo moved"
        ),
        pytest.param(b"", Verdict.UNWANTED, id="nothing"),
        pytest.param(b"\xc1\xff", Verdict.UNWANTED, id="no msgpack"),
        pytest.param(msgspec.msgpack.encode([1, 2]), Verdict.UNWANTED, id="a list"),
        pytest.param(msgspec.msgpack.encode({"type": 7}), Verdict.UNWANTED, id="a type that is a number"),
        pytest.param(b"\x91" * 5000, Verdict.UNWANTED, id="nested without end"),
        pytest.param(b"\x81\xa4type\xa2\xff\xff", Verdict.UNWANTED, id="a type that is no text"),
        pytest.param("ViewerCameraMessage", Verdict.UNWANTED, id="text"),
        pytest.param(None, Verdict.UNWANTED, id="no payload"),
        pytest.param(
            message("ViewerCameraMessage", pad=b"x" * LARGEST_MESSAGE_BYTES),
            Verdict.TOO_LARGE,
            id="over 64 kB",
        ),
    ],
)
def test_only_camera_messages_are_accepted(sent: bytes | str | None, verdict: Verdict) -> None:
    gate = Gate(counts={})
    assert gate.judge(sent, now_s=0.0) is verdict
    assert gate.counts == {verdict: 1}
    assert gate.rejections == (verdict is not Verdict.CAMERA)


def test_a_flood_is_cut_and_the_allowance_comes_back() -> None:
    gate = Gate(counts={})
    camera = message("ViewerCameraMessage")
    flood = [gate.judge(camera, now_s=5.0) for _ in range(int(BURST) + 10)]
    assert flood.count(Verdict.TOO_OFTEN) == 10
    assert gate.judge(camera, now_s=5.5) is Verdict.CAMERA


def test_a_viewer_that_goes_on_must_go() -> None:
    gate = Gate(counts={})
    for _ in range(500):
        gate.judge(b"", now_s=0.0)
    assert not gate.goodbye
    gate.judge(b"", now_s=0.0)
    assert gate.goodbye
