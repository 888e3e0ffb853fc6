"""Byte-by-byte copy of messages from one recording to another."""

from pathlib import Path
from types import TracebackType
from typing import Any

from server.recording_file.reader import RecordedMessage, RecordingReader
from server.recording_file.topics import JSON, PROFILE, Topic
from server.recording_file.writer import CHUNK_BYTES, mcap_writer, register_json_schema


class RecordingCopy:
    """A recording with messages of another one; a context manager that closes the file.

    Args:
        target: The new file.
        source: Source of the messages.

    Raises:
        OSError: The file cannot be written.
    """

    def __init__(self, target: Path, source: RecordingReader) -> None:
        self._source = source
        self._channels: dict[int, int] = {}
        self._schemas: dict[int, int] = {0: 0}
        self._file = target.open("wb")
        self._writer = mcap_writer(self._file, chunk_bytes=CHUNK_BYTES)
        self._writer.start(profile=PROFILE, library=source.library)

    def __enter__(self) -> "RecordingCopy":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        try:
            if kind is None:
                self._writer.finish()
        finally:
            self._file.close()

    def add(self, message: RecordedMessage, *, log_ns: int | None = None) -> None:
        """Add a message of the source, at another time if `log_ns` is given."""
        self._writer.add_message(
            self._channel(message.channel_id),
            log_time=message.log_ns if log_ns is None else log_ns,
            data=message.content,
            publish_time=message.log_ns,
            sequence=message.sequence,
        )

    def add_json(self, topic: Topic, text: str, *, log_ns: int, schema: dict[str, Any]) -> None:
        """Add a new JSON message."""
        schema_id = register_json_schema(self._writer, schema, title=topic.value)
        channel_id = self._writer.register_channel(
            topic=topic.value, message_encoding=JSON, schema_id=schema_id
        )
        self._writer.add_message(channel_id, log_time=log_ns, data=text.encode(), publish_time=log_ns)

    def _channel(self, channel_id: int) -> int:
        if channel_id not in self._channels:
            channel = self._source.channels[channel_id]
            self._channels[channel_id] = self._writer.register_channel(
                topic=channel.topic,
                message_encoding=channel.message_encoding,
                schema_id=self._schema(channel.schema_id),
                metadata=channel.metadata,
            )
        return self._channels[channel_id]

    def _schema(self, schema_id: int) -> int:
        if schema_id not in self._schemas:
            schema = self._source.schemas[schema_id]
            self._schemas[schema_id] = self._writer.register_schema(
                name=schema.name, encoding=schema.encoding, data=schema.data
            )
        return self._schemas[schema_id]
