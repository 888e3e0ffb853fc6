"""Finding a calibration board in an image: which of its points lie where, to a fraction of a pixel."""

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
