"""A small recording of numbered images."""

from pathlib import Path

import numpy as np

from server.recording_file import ImagePacker, RecordingWriter, Topic, WriterLimits

NO_LIMITS = WriterLimits(max_bytes=1e12, min_free_bytes=0)
OFFSET_S = 1_700_000_000.0
RATE_HZ = 10.0


def made_writer(path: Path, limits: WriterLimits = NO_LIMITS) -> RecordingWriter:
    """Return a writer with one topic."""
    writer = RecordingWriter(path, limits=limits, unix_offset_s=OFFSET_S, library="coaxial test")
    writer.register(Topic.NOTE, {"title": "Note", "type": "object"})
    return writer


def write_images(writer: RecordingWriter, count: int) -> None:
    """Write images with their number as level, each with a note, ten a second."""
    packer = ImagePacker()
    for number in range(count):
        at_s = number / RATE_HZ
        writer.add_json(Topic.NOTE, at_s, f'{{"code": "N", "message": "{number}", "images": 0}}')
        image = np.full((8, 12, 3), number, np.uint8)
        image[0, 0, 0] += 1
        writer.add_image(packer.pack(image), number=number, at_s=at_s)
        writer.tick(at_s)


def write_recording(path: Path, count: int = 20) -> Path:
    """Write a whole recording."""
    writer = made_writer(path)
    write_images(writer, count)
    writer.close()
    return path
