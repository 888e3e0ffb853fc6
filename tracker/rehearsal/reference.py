"""The patient reference: a second marker on a post that is clamped to the spinous process."""

from functools import lru_cache

import numpy as np

from tracker.geometry import Array, Camera, Reference, Rigid, Vertebra, rotation_from_vector
from tracker.marker import MarkerModel
from tracker.rehearsal.marker_images import reference_marker_image

REFERENCE_SIDE_MM = 30.0
REFERENCE_QUIET_MM = 5.0
REFERENCE_HALF_MM = REFERENCE_SIDE_MM / 2.0 + REFERENCE_QUIET_MM
# Over the edge of the wound at the patient's right and feet: in front of no bone, needle or drill.
CENTRE_IN_VERTEBRA_MM = np.array([-56.0, 42.0, -62.0])
CLAMP_IN_VERTEBRA_MM = np.array([-2.0, 36.0, -15.0])
TILT_DEG = (22.0, 36.0)


@lru_cache(maxsize=1)
def reference_marker() -> MarkerModel:
    """Return the printed marker ("reference", 30 mm)."""
    return MarkerModel.from_image(reference_marker_image(), side_mm=REFERENCE_SIDE_MM, name="reference")


def reference_from_vertebra(
    camera_from_vertebra: Rigid[Camera, Vertebra], seed: int
) -> Rigid[Reference, Vertebra]:
    """Return the pose of the reference: facing the camera obliquely, varied by the seed.

    A frontal view of a square hardly determines its tilt.
    """
    random = np.random.default_rng([seed, 0x52454645])
    camera_mm = camera_from_vertebra.inverse.translation_mm
    facing = camera_mm - CENTRE_IN_VERTEBRA_MM
    facing /= np.linalg.norm(facing)
    # Upright in the image: the camera's y runs down.
    up = -camera_from_vertebra.rotation[1]
    up = up - (up @ facing) * facing
    up /= np.linalg.norm(up)
    square = np.stack([np.cross(up, facing), up, facing], axis=1)
    # The upper edge away from the camera more than to it: so the board is leant on its post.
    way = np.radians(random.uniform(-150.0, -30.0))
    tilt = np.radians(random.uniform(*TILT_DEG))
    roll = np.radians(random.uniform(-12.0, 12.0))
    leant = rotation_from_vector(tilt * np.array([np.sin(way), np.cos(way), 0.0]))
    rolled = rotation_from_vector(np.array([0.0, 0.0, roll]))
    vertebra_from_reference: Rigid[Vertebra, Reference] = Rigid(
        rotation=square @ leant @ rolled, translation_mm=CENTRE_IN_VERTEBRA_MM
    )
    return vertebra_from_reference.inverse


def reference_board_mm(z_mm: float = 0.0) -> Array:
    """Return the board's corners (4, 3) in its marker's frame."""
    return np.array([[-1, 1, 0], [1, 1, 0], [1, -1, 0], [-1, -1, 0]]) * REFERENCE_HALF_MM + [0.0, 0.0, z_mm]
