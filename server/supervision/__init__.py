"""Who watches, what they point at, draw and sign, and whether they ask to hold. Nothing here moves anything.

people.py        who is here, each person once, and how their line does
marks.py         pointers and drawings, in pixels of the image that they were made on
room.py          both together, with what each may do; pure: time is handed in
told.py          what one connection has been told, so that it is told only what is new
lobby.py         the room with its clock, and who waits for news
holds.py         who asks to hold
asked.py         the same on the disk, so that a start of the server forgets nobody
signatures.py    co-signatures of plan and registration
"""

from server.supervision.asked import HoldsFile
from server.supervision.holds import Holds
from server.supervision.lobby import Lobby
from server.supervision.people import View
from server.supervision.room import Unfair
from server.supervision.signatures import SignatureDesk

__all__ = ["Holds", "HoldsFile", "Lobby", "SignatureDesk", "Unfair", "View"]
