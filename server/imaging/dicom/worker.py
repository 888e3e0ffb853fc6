"""A program that decodes compressed images, run in a process of its own by `decoding`.

GDCM's decoders are compiled code that ends the whole process when a stream is damaged; here that is this
process, and nobody else. It is started as a file, so that it loads pydicom and nothing of ours. It reads
requests from its standard input until that ends (two lengths, a JSON header, the encapsulated pixels), and
answers alike.
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

# What a stream may make a decoder take, however large an image it claims to hold.
MAX_MEMORY_BYTES = 4 * 2**30
LENGTHS = struct.Struct("<II")


def main() -> None:
    """Answer requests until there are none."""
    with contextlib.suppress(ImportError, ValueError, OSError):
        import resource  # noqa: PLC0415  not there on every system

        resource.setrlimit(resource.RLIMIT_AS, (MAX_MEMORY_BYTES, MAX_MEMORY_BYTES))
    with contextlib.suppress(OSError):
        os.nice(10)  # The tracker's images come first.
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
    """A header and the bytes that belong to it; None where the other side has ended."""
    lengths = stream.read(LENGTHS.size)
    if len(lengths) < LENGTHS.size:
        return None
    header_bytes, content_bytes = LENGTHS.unpack(lengths)
    header, content = stream.read(header_bytes), stream.read(content_bytes)
    if len(header) < header_bytes or len(content) < content_bytes:
        return None
    return json.loads(header), content


def write_message(stream: BinaryIO, header: dict[str, object], content: bytes) -> None:
    """The counterpart of `read_message`."""
    encoded = json.dumps(header).encode()
    stream.write(LENGTHS.pack(len(encoded), len(content)))
    stream.write(encoded)
    stream.write(content)
    stream.flush()


if __name__ == "__main__":
    main()
