"""Size in a JPEG's header, read before decoding: a small file may declare an image of gigabytes."""

START, END = b"\xff\xd8", b"\xff\xd9"
# Baseline, extended and progressive Huffman-coded frames, as browsers write them.
FRAME_MARKERS = frozenset({0xC0, 0xC1, 0xC2})
# Markers without a length field: fill, TEM, restarts.
BARE_MARKERS = frozenset({0xFF, 0x01, *range(0xD0, 0xD8)})
START_OF_SCAN = 0xDA


def jpeg_size_wh_px(content: bytes) -> tuple[int, int] | None:
    """Return width and height of a complete JPEG; None for a truncated or other file, or without a size."""
    if not content.startswith(START) or not content.endswith(END):
        return None
    at = len(START)
    while at + 9 <= len(content) and content[at] == 0xFF:
        marker = content[at + 1]
        if marker in BARE_MARKERS:
            at += 1 if marker == 0xFF else 2
            continue
        if marker == START_OF_SCAN:
            return None
        if marker in FRAME_MARKERS:
            height = int.from_bytes(content[at + 5 : at + 7], "big")
            width = int.from_bytes(content[at + 7 : at + 9], "big")
            return (width, height) if width and height else None
        at += 2 + int.from_bytes(content[at + 2 : at + 4], "big")
    return None
