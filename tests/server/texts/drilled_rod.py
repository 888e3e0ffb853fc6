"""A camera above the rod of `tests.tracker.navigation.bones`, and a drill at a prescribed place."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from tests.tracker.navigation.assessed import drill
from tests.tracker.navigation.bones import ROD_CHANNEL, drill_at
from tracker.camera import CameraModel
from tracker.geometry import Camera, Marker, Rigid, Vertebra
from tracker.navigation import DrillReference, NavigationSnapshot, Setup, navigate
from tracker.pose import Seen, Sighting, ToolModel, Unseen, UnseenReason
from tracker.registration import Registration

SIZE_WH_PX = (1280, 720)
CAMERA = CameraModel(
    matrix=np.array([[1400.0, 0.0, 640.0], [0.0, 1400.0, 360.0], [0.0, 0.0, 1.0]]),
    distortion=np.zeros(5),
    size_wh_px=SIZE_WH_PX,
)
# The rod runs forwards from its back: seen from behind and above.
CAMERA_FROM_VERTEBRA = Rigid[Camera, Vertebra].from_vector([-1.2, 0.3, 0.1], [0.0, 20.0, 300.0])
SD = np.array([0.08] * 3 + [0.0004] * 3)
CORNERS_MM = [[-12.5, 12.5, 0.0], [12.5, 12.5, 0.0], [12.5, -12.5, 0.0], [-12.5, -12.5, 0.0]]
UNSEEN = Unseen(reason=UnseenReason.NO_CANDIDATE)
# Depth, medial and cranial offset at the entry [mm], medial and cranial angle [deg], and the factor of
# the pose's uncertainty.
Where: TypeAlias = Sequence[float] | npt.NDArray[np.float64]


def setup_of(names: Collection[str] = ("drill",), *, registered_sd_mm: float = 0.0) -> Setup:
    """A calibrated camera, these tools, and the rod's channel, registered to this standard deviation."""
    shift = np.diag([registered_sd_mm**2] * 3 + [0.0] * 3)
    return Setup(
        camera=CAMERA,
        camera_calibrated=True,
        tools={name: drill(name) for name in names},
        channel=ROD_CHANNEL,
        registration=replace(Registration.known_to_camera(CAMERA_FROM_VERTEBRA), covariance=shift),
        side="left",
    )


def seen_at(where: Where, tool: ToolModel) -> Seen:
    """The marker of a drill at this place."""
    depth, medial, cranial, medial_deg, cranial_deg, unsure = (float(each) for each in where)
    placed = drill_at(
        ROD_CHANNEL,
        depth,
        medial_mm=medial,
        cranial_mm=cranial,
        medial_deg=medial_deg,
        cranial_deg=cranial_deg,
    )
    pose: Rigid[Camera, Marker] = CAMERA_FROM_VERTEBRA @ placed @ tool.marker_from_tool.inverse
    return Seen(
        camera_from_marker=pose,
        pose_covariance=np.diag((unsure * SD) ** 2),
        corners_px=CAMERA.px_from_camera(pose.move_points(CORNERS_MM)),
        score_ratio=0.9,
        target_score_ratio=0.9,
        model_coverage_ratio=0.9,
        target_coverage_ratio=0.9,
        fit_error_px2=0.1,
        found_by="track",
    )


def concluded(
    setup: Setup,
    drill_reference: DrillReference,
    sightings: Mapping[str, Sighting],
    *,
    number: int,
    captured_at_s: float,
) -> NavigationSnapshot:
    """The snapshot of an image in which these were seen."""
    return navigate(
        setup=setup,
        sightings=sightings,
        image_number=number,
        captured_at_s=captured_at_s,
        size_wh_px=SIZE_WH_PX,
        stage_ms={},
        skipped_images=0,
        drill_reference=drill_reference,
    )
