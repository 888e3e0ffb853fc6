"""Detection of a calibration board in an image: identified points with sub-pixel positions."""

from tracker.camera.detection.find import board_as_seen, find_board
from tracker.camera.detection.view import BoardNotFound, BoardView, NotFoundReason, PlacementAmbiguity

__all__ = [
    "BoardNotFound",
    "BoardView",
    "NotFoundReason",
    "PlacementAmbiguity",
    "board_as_seen",
    "find_board",
]
