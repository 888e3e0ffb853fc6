"""Assembles the poses of an external tracker from OpenIGTLink messages; time is that of the messages.

Poses are combined only if they have the same time stamp: a drill of one moment in a patient of another would
be off by what moved between them. Plus sends all transforms of a moment with one stamp. A moment is complete
with its last body; otherwise what is missing is known with the first message of the next moment.

A body is missing where the tracker says so: by the metadata of Plus (`TransformStatus`, in TDATA the name
with `Status`), by a STATUS of its name that is not OK, or by an identity matrix, which Plus sends to a client
without metadata. It is also missing where its pose repeats bit by bit: a measured pose has noise.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from server.openigtlink_wire import (
    Message,
    StatusCode,
    WireError,
    status_of,
    tracked_tools_of,
    transform_of,
)
from tracker.errors import InvalidInput
from tracker.geometry import Array, Camera, Marker, Rigid

# As for an image that a camera repeats.
FROZEN_AFTER_S = 0.25
# No tracker measures farther; greater numbers are not millimetres.
MAX_DISTANCE_MM = 10_000.0
VALID = "OK"


@dataclass(frozen=True, slots=True, kw_only=True)
class PoseFrame:
    """The valid poses of one moment.

    Attributes:
        stamp_s: time of the moment by the clock of the sender.
        poses: by body; the frame of the tracker takes the place of the camera's.
    """

    stamp_s: float
    poses: Mapping[str, Rigid[Camera, Marker]]


class PoseFrames:
    """Frames of one connection. Mutable.

    Args:
        bodies: names of the transforms, each from a body to the tracker.
    """

    def __init__(self, bodies: Sequence[str]) -> None:
        self._bodies = frozenset(bodies)
        self._stamp_s = 0.0
        self._matrices: dict[str, Array | None] = {}
        self._is_returned = True
        self._repeated: dict[str, tuple[bytes, float]] = {}

    def take(self, message: Message) -> PoseFrame | None:
        """Return the newest frame that is complete with this message, each once; None if there is none.

        Messages that are not newer than the last frame, and those about nothing that is tracked, are ignored.

        Raises:
            WireError: a body cannot be parsed, a stamp is missing, or a matrix is not a rigid motion in mm.
        """
        matrices = {name: one for name, one in _matrices_of(message) if name in self._bodies}
        if not matrices:
            return None
        if message.timestamp_s == 0.0:
            raise WireError(f"{message.type} {message.device} has no time stamp")
        before = None
        if message.timestamp_s > self._stamp_s:
            before = None if self._is_returned else self._frame()
            self._stamp_s, self._matrices, self._is_returned = message.timestamp_s, {}, False
        elif message.timestamp_s < self._stamp_s or self._is_returned:
            return None
        self._matrices.update(matrices)
        if self._matrices.keys() < self._bodies:
            return before
        self._is_returned = True
        return self._frame()

    def _frame(self) -> PoseFrame:
        poses = {}
        for name, matrix in self._matrices.items():
            if matrix is not None and not self._is_frozen(name, matrix):
                poses[name] = _pose(name, matrix)
        return PoseFrame(stamp_s=self._stamp_s, poses=poses)

    def _is_frozen(self, name: str, matrix: Array) -> bool:
        content = matrix.tobytes()
        before, since_s = self._repeated.get(name, (b"", 0.0))
        if content != before:
            self._repeated[name] = (content, self._stamp_s)
            return False
        return self._stamp_s - since_s > FROZEN_AFTER_S


def _matrices_of(message: Message) -> Iterator[tuple[str, Array | None]]:
    """Yield what a message states about bodies: matrices (4, 4), or None where a pose is not valid."""
    if message.type == "TRANSFORM":
        is_valid = message.metadata.get("TransformStatus", VALID) == VALID
        yield message.device, _measured(transform_of(message.content)) if is_valid else None
    elif message.type == "TDATA":
        for name, matrix in tracked_tools_of(message.content).items():
            is_valid = message.metadata.get(f"{name}Status", VALID) == VALID
            yield name, _measured(matrix) if is_valid else None
    elif message.type == "STATUS" and status_of(message.content).code != StatusCode.OK:
        yield message.device, None


def _measured(matrix: Array) -> Array | None:
    """Return a matrix; None for the identity, which is no measurement."""
    return None if np.array_equal(matrix, np.eye(4)) else matrix


def _pose(name: str, matrix: Array) -> Rigid[Camera, Marker]:
    try:
        pose: Rigid[Camera, Marker] = Rigid.from_matrix(matrix)
    except InvalidInput as error:
        raise WireError(f"{name}: {error.message}") from error
    distance_mm = float(np.linalg.norm(pose.translation_mm))
    if distance_mm > MAX_DISTANCE_MM:
        raise WireError(f"{name} is {distance_mm:.3g} mm away, allowed are {MAX_DISTANCE_MM:g} mm")
    return pose
