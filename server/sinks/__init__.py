"""Plug-ins that receive each published message: each in a process of its own, newest wins."""

from server.sinks.sink import Sink, SinkStatus
from server.sinks.sinks import Sinks

__all__ = ["Sink", "SinkStatus", "Sinks"]
