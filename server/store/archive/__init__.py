"""A case as one file: packed for another machine, and taken in again whole or not at all."""

from server.store.archive.packing import Archive, pack
from server.store.archive.unpacking import unpack

__all__ = ["Archive", "pack", "unpack"]
