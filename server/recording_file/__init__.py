"""The file of a recording: MCAP, with images, messages, alarms, and the state of tracking.

codec.py      values of the program as JSON and back
copy.py       writes messages of one recording into another
locations.py  where messages lie in the file
packing.py    images
topics.py     what is in the file
writer.py     writes it, so that a crash loses less than a second
reader.py     reads it, up to where it was cut
"""

from server.recording_file.codec import CodecError, decoded_value, encoded_value
from server.recording_file.packing import ImagePacker, PackedImage, Packing, unpacked
from server.recording_file.reader import RecordedMessage, RecordingReader
from server.recording_file.topics import Topic
from server.recording_file.writer import RecordingWriter, WriterLimits

__all__ = [
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
    "encoded_value",
    "unpacked",
]
