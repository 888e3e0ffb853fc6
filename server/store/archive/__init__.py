"""Export of a case as one archive file, and its atomic import."""

from server.store.archive.packing import Archive, pack
from server.store.archive.unpacking import unpack

__all__ = ["Archive", "pack", "unpack"]
