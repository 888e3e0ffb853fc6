"""A picture and the live message of its image in one message, as on `/ws/view`.

The hub shows both together: a picture beside the message of another image would have another image's age.
"""

import struct

HEADER_LENGTH = struct.Struct("<I")
PICTURE_WIDTH_PX = 320


def picture_packed(live_text: str, jpeg: bytes) -> bytes:
    """Return the length of the live message (uint32, little endian), the message, and the JPEG."""
    header = live_text.encode()
    return b"".join((HEADER_LENGTH.pack(len(header)), header, jpeg))


def picture_unpacked(content: bytes) -> tuple[bytes, bytes]:
    """Return live message and JPEG.

    Raises:
        ValueError: it is no such message.
    """
    if len(content) < HEADER_LENGTH.size:
        raise ValueError(f"a picture of {len(content)} bytes has no header")
    end = HEADER_LENGTH.size + HEADER_LENGTH.unpack_from(content)[0]
    if end > len(content):
        raise ValueError(f"the header of a picture ends at {end} of {len(content)} bytes")
    return content[HEADER_LENGTH.size : end], content[end:]
