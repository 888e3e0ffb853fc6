import pytest

from server.capture.address import SourceKind, source_from_text


@pytest.mark.parametrize(
    ("text", "kind", "name"),
    [
        pytest.param("rehearsal", SourceKind.REHEARSAL, "rehearsal", id="rehearsal"),
        pytest.param(0, SourceKind.LOCAL_CAMERA, "camera 0", id="number-in-the-settings"),
        pytest.param("2", SourceKind.LOCAL_CAMERA, "camera 2", id="number-typed"),
        pytest.param("/dev/video4", SourceKind.LOCAL_CAMERA, "/dev/video4", id="device"),
        pytest.param("basler:40021234", SourceKind.INDUSTRIAL_CAMERA, "basler:40021234", id="basler"),
        pytest.param("GenICam: a1 ", SourceKind.INDUSTRIAL_CAMERA, "genicam:a1", id="genicam"),
        pytest.param("basler:", SourceKind.INDUSTRIAL_CAMERA, "basler:", id="the-only-basler"),
        pytest.param("basler.mp4", SourceKind.PATH, "basler.mp4", id="file-of-that-name"),
        pytest.param("film.mov", SourceKind.PATH, "film.mov", id="file"),
        pytest.param("images/today", SourceKind.PATH, "images/today", id="folder"),
        pytest.param("http://h/x", SourceKind.STREAM, "http://h/x", id="open-stream"),
        pytest.param(
            "rtsp://me:pa:ss@cam:554/live", SourceKind.STREAM, "rtsp://me:***@cam:554/live", id="password"
        ),
        pytest.param(
            "https://h/x?user=a&pwd=secret&token=t&q=1",
            SourceKind.STREAM,
            "https://h/x?user=a&pwd=***&token=***&q=1",
            id="password-in-the-query",
        ),
        pytest.param("rtsp://secret@cam/live", SourceKind.STREAM, "rtsp://***@cam/live", id="key-as-user"),
        pytest.param(
            "rtsp://me:pa/ss@cam/live?key=1", SourceKind.STREAM, "rtsp://***@cam/live?key=***", id="slash"
        ),
        pytest.param("rtsp://me:pa#ss@cam/live", SourceKind.STREAM, "rtsp://***@cam/live", id="hash"),
        pytest.param("http://[bad:secret@h/x", SourceKind.STREAM, "http://***", id="not-understood"),
    ],
)
def test_the_kind_is_distinguished_from_the_text_and_secrets_are_masked(
    text: str | int, kind: SourceKind, name: str
) -> None:
    address = source_from_text(text)
    assert (address.kind, address.name) == (kind, name)
