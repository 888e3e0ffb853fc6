"""Program that decodes compressed images, run in a separate process by `decoding`.

GDCM's decoders may crash their process on a damaged stream. The program is started as a file, so that it
loads only pydicom. It reads requests from standard input until its end (two lengths, a JSON header, the
encapsulated pixels), and writes responses in the same format.
"""

import contextlib
import json
import os
import struct
import sys
import warnings
from typing import Any, BinaryIO

from pydicom.pixels.decoders.base import get_decoder
from pydicom.uid import UID

# Memory limit of a decoder, whatever image size a stream declares.
MAX_MEMORY_BYTES = 4 * 2**30
LENGTHS = struct.Struct("<II")


def main() -> None:
    """Answer requests until there are none."""
    with contextlib.suppress(ImportError, ValueError, OSError):
        import resource  # noqa: PLC0415  not there on every system

        resource.setrlimit(resource.RLIMIT_AS, (MAX_MEMORY_BYTES, MAX_MEMORY_BYTES))
    with contextlib.suppress(OSError):
        os.nice(10)  # Tracking has priority.
    warnings.simplefilter("ignore")
    while request := read_message(sys.stdin.buffer):
        header, encapsulated = request
        try:
            options: dict[str, Any] = {**header, "pixel_keyword": "PixelData"}
            decoder = get_decoder(UID(str(options.pop("transfer_syntax_uid"))))
            pixels, _ = decoder.as_array(encapsulated, index=0, raw=True, decoding_plugin="gdcm", **options)
            answer: dict[str, object] = {"dtype": pixels.dtype.str, "shape": list(pixels.shape)}
            write_message(sys.stdout.buffer, answer, pixels.tobytes())
        except Exception:  # noqa: BLE001  whatever a damaged stream leads to, the asking side tells it once
            write_message(sys.stdout.buffer, {}, b"")


def read_message(stream: BinaryIO) -> tuple[dict[str, object], bytes] | None:
    """Return a header and its content; None at the end of the stream."""
    lengths = stream.read(LENGTHS.size)
    if len(lengths) < LENGTHS.size:
        return None
    header_bytes, content_bytes = LENGTHS.unpack(lengths)
    header, content = stream.read(header_bytes), stream.read(content_bytes)
    if len(header) < header_bytes or len(content) < content_bytes:
        return None
    return json.loads(header), content


def write_message(stream: BinaryIO, header: dict[str, object], content: bytes) -> None:
    """Write a header and its content, see `read_message`."""
    encoded = json.dumps(header).encode()
    stream.write(LENGTHS.pack(len(encoded), len(content)))
    stream.write(encoded)
    stream.write(content)
    stream.flush()


if __name__ == "__main__":
    main()
