"""OpenIGTLink: sends poses, points, headline and their absence to 3D Slicer, Plus and other programs.

wire.py      messages as bytes, both ways; pure
contents.py  the messages of one instant
feed.py      what one client gets now, and what it must no longer take for valid; pure, time is a number
requests.py  what a client sends, out of a stream of bytes; pure
server.py    the listening socket and its clients

The protocol has neither encryption nor sign-in, so the server listens on loopback, unless another address is
set and the setting `unencrypted` states what that means.
"""

from server.openigtlink.server import OpenIgtLinkServer

__all__ = ["OpenIgtLinkServer"]
