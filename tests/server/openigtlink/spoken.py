"""Parses OpenIGTLink messages, and builds contents of instants for a feed."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from server import openigtlink_wire as wire
from server.config import OpenIgtLinkConfig
from server.openigtlink.contents import InstantContents, contents_of
from server.openigtlink_wire import Message
from tests.server.conftest import make_instant
from tracker.navigation import NavigationSnapshot

Said = dict[tuple[str, str], object]
_READ: dict[str, Callable[[bytes], object]] = {
    "TRANSFORM": wire.transform_of,
    "POINT": wire.points_of,
    "STRING": wire.string_of,
    "STATUS": lambda content: wire.status_of(content).name,
}


def said(messages: Sequence[Message]) -> Said:
    """Content of each message by type and device; of a status its name."""
    return {(one.type, one.device): _READ.get(one.type, bytes)(one.content) for one in messages}


def contents(snapshot: NavigationSnapshot | None, **more: Any) -> InstantContents:  # noqa: ANN401  fields
    """Contents of an instant with this snapshot and other fields."""
    instant = replace(make_instant(0, snapshot=snapshot), **more)
    return contents_of(instant, OpenIgtLinkConfig(), language="en")
