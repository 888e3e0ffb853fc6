"""Packets of viser, decoded as by its client."""

from typing import Any

import msgspec
import zstandard


def viser_messages(packet: bytes) -> list[dict[str, Any]]:
    """Return the messages of a packet."""
    size, length = int.from_bytes(packet[:8], "little"), int.from_bytes(packet[8:16], "little")
    plain = zstandard.ZstdDecompressor().decompress(packet[16 : 16 + length], max_output_size=size)
    return list(msgspec.msgpack.decode(plain)["messages"])
