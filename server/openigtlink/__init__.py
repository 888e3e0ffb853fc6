"""OpenIGTLink: sends poses, points, headline and their absence to 3D Slicer, Plus and other programs.

contents.py  messages of one instant
feed.py      messages to one client, including those on expired content; pure, time is passed in
requests.py  parsing of requests of a client; pure
server.py    listening socket and clients

The protocol has neither encryption nor sign-in. The server therefore listens on loopback, unless another
address is set and confirmed by the setting `unencrypted`.
"""

from server.openigtlink.server import OpenIgtLinkServer

__all__ = ["OpenIgtLinkServer"]
