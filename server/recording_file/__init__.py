"""File format of a recording: MCAP with images, messages, alarms, and the tracking state.

codec.py      conversion of records of the program to JSON and back
copy.py       copies messages of one recording to another
locations.py  positions of messages in the file
packing.py    encoding of images
topics.py     topics of the file
writer.py     writer; a crash loses less than a second
reader.py     reader, also of an incomplete file
"""

from server.recording_file.codec import CodecError, decoded_value, encoded_value
from server.recording_file.packing import ImagePacker, PackedImage, Packing, unpacked
from server.recording_file.reader import (
    OTHER_CONTENT,
    RecordedMessage,
    RecordingReader,
    decompressed_json,
    rejecting_other_content,
)
from server.recording_file.topics import Topic
from server.recording_file.writer import RecordingWriter, WriterLimits

__all__ = [
    "OTHER_CONTENT",
    "CodecError",
    "ImagePacker",
    "PackedImage",
    "Packing",
    "RecordedMessage",
    "RecordingReader",
    "RecordingWriter",
    "Topic",
    "WriterLimits",
    "decoded_value",
    "decompressed_json",
    "encoded_value",
    "rejecting_other_content",
    "unpacked",
]
