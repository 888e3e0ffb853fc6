"""What a registration by needles is asked, what it looks at, and what it lays over the image."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from server.procedure.registration.ground import Ground
from tracker.camera import CameraModel
from tracker.geometry import Array, Camera, Rigid, Vertebra
from tracker.navigation import NavigationSnapshot
from tracker.plan import ReferenceSlice
from tracker.registration.needles import (
    MeasuredView,
    NeedleFit,
    NeedlePlace,
    NeedleSeen,
    OverlayResidual,
    SliceOverlay,
    TouchedPoint,
    View,
    view_from_ruler,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class NeedleOrder:
    """What the needles are, and what a ruler tells of the camera.

    Attributes:
        vertebra: its name in the plan; the one that is to be drilled if None.
        landmarks: where the needles go in; none takes the three lines of the reference slice.
        measured: tilt and distance of the camera.
        radius_mm: of the needles' wire.
    """

    vertebra: str | None
    landmarks: tuple[str, ...]
    measured: MeasuredView
    radius_mm: float = 0.8


@dataclass(frozen=True, slots=True, kw_only=True)
class NeedleScene:
    """One image, and the needles that are planned to be in it.

    Attributes:
        ground: what the registration stands on.
        places: of the needles.
        reference: the slice with its lines; None where the needles stand on landmarks.
        camera: calibrated.
        image: (h, w, 3) BGR, as the camera gave it.
        snapshot: what the image says.
        measured: tilt and distance of the camera.
        touched: landmarks that the tool's tip was held on, before the camera.
    """

    ground: Ground
    places: tuple[NeedlePlace, ...]
    reference: ReferenceSlice | None
    camera: CameraModel
    image: npt.NDArray[np.uint8]
    snapshot: NavigationSnapshot
    measured: MeasuredView
    touched: tuple[TouchedPoint, ...]

    def view(self, at_px: npt.ArrayLike | None = None) -> View:
        """Tilt and distance for needles that are seen here (2,), by default in the middle."""
        middle = 0.5 * np.array(self.camera.size_wh_px) if at_px is None else at_px
        return view_from_ruler(self.measured, self.camera, middle, touched=self.touched)


@dataclass(frozen=True, slots=True, kw_only=True)
class LaidSlice:
    """The slice as it lies over the image.

    Attributes:
        scene: what it lies over.
        overlay: where it lies.
        camera_from_vertebra: the pose that it stands for.
        lines_px: (needles, points, 2) where the needles' lines run.
        residuals: how each needle that was marked lies beside its line.
        fit: of the needles to the plan; None where it was only laid.
    """

    scene: NeedleScene
    overlay: SliceOverlay
    camera_from_vertebra: Rigid[Camera, Vertebra]
    lines_px: Array
    residuals: tuple[OverlayResidual, ...]
    fit: NeedleFit | None


@dataclass(frozen=True, slots=True, kw_only=True)
class ProposedSlice:
    """One likely way of naming the needles that were found, for a person to pick.

    Attributes:
        laid: the fit, if this is which needle is which.
        found: the needles in the image, in the plan's order.
        probability_ratio: 0..1, how likely this one is among those that are proposed.
        lead: by how much the likeliest other one is worse, as a difference of chi squared.
    """

    laid: LaidSlice
    found: tuple[NeedleSeen, ...]
    probability_ratio: float
    lead: float
