"""Presence, marks, hold requests and co-signatures of viewers. Nothing here moves anything.

participants.py     people present, each once, and the state of their connection
marks.py            pointers and drawings, in pixels of an image or in mm on the plane of a cut
room.py             participants and marks, with the permissions of each role; pure: time is passed in
room_updates.py     the state already sent to one connection, so that only changes are sent
room_hub.py         the room with its clock and its subscribers
token_bucket.py     rate limit of one page
hold_requests.py    hold requests
hold_storage.py     storage of hold requests, so that they survive a restart
signatures.py       co-signatures of plan and registration
"""

from server.supervision.hold_requests import HoldRequests
from server.supervision.hold_storage import HoldRequestFile
from server.supervision.participants import View
from server.supervision.room import RoomPolicyViolation
from server.supervision.room_hub import RoomHub
from server.supervision.signatures import SignatureService

__all__ = ["HoldRequestFile", "HoldRequests", "RoomHub", "RoomPolicyViolation", "SignatureService", "View"]
