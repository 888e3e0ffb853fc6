"""Records of the needle registration: request, scene, and the slice placed over the image."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from server.procedure.registration.context import RegistrationContext
from tracker.camera import CameraModel
from tracker.geometry import Array, Camera, Rigid, Vertebra
from tracker.navigation import NavigationSnapshot
from tracker.plan import ReferenceSlice
from tracker.registration.needles import (
    NeedleFit,
    NeedleObservation,
    OverlayResidual,
    PlannedNeedle,
    RulerMeasurement,
    SliceOverlay,
    TouchedPoint,
    ViewPrior,
    view_prior_from_ruler,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class NeedleRequest:
    """The needles, and the camera position measured with a ruler.

    Attributes:
        vertebra: its name in the plan; that of the active channel if None.
        landmarks: landmarks at which the needles enter; empty for the three lines of the reference slice.
        measured: measured tilt and distance of the camera.
        radius_mm: radius of the needles.
    """

    vertebra: str | None
    landmarks: tuple[str, ...]
    measured: RulerMeasurement
    radius_mm: float = 0.8


@dataclass(frozen=True, slots=True, kw_only=True)
class NeedleScene:
    """One image with the planned needles.

    Attributes:
        context: context of the registration.
        places: planned positions of the needles.
        reference: the reference slice with its lines; None if the needles are at landmarks.
        camera: the calibrated camera.
        image: (h, w, 3) BGR, as captured.
        snapshot: navigation result of the image.
        measured: measured tilt and distance of the camera.
        touched: landmarks captured with the tool tip, in the camera frame.
    """

    context: RegistrationContext
    places: tuple[PlannedNeedle, ...]
    reference: ReferenceSlice | None
    camera: CameraModel
    image: npt.NDArray[np.uint8]
    snapshot: NavigationSnapshot
    measured: RulerMeasurement
    touched: tuple[TouchedPoint, ...]

    def view(self, at_px: npt.ArrayLike | None = None) -> ViewPrior:
        """Return the view for needles at this image position (2,), by default the image centre."""
        middle = 0.5 * np.array(self.camera.size_wh_px) if at_px is None else at_px
        return view_prior_from_ruler(self.measured, self.camera, middle, touched=self.touched)


@dataclass(frozen=True, slots=True, kw_only=True)
class PlacedSlice:
    """The reference slice placed over the image.

    Attributes:
        scene: the image with the planned needles.
        overlay: position of the slice in the image.
        camera_from_vertebra: the corresponding pose.
        lines_px: (needles, points, 2) projected needle lines.
        residuals: residual of each marked needle to its line.
        fit: fit of the needles to the plan; None if the slice was only placed.
    """

    scene: NeedleScene
    overlay: SliceOverlay
    camera_from_vertebra: Rigid[Camera, Vertebra]
    lines_px: Array
    residuals: tuple[OverlayResidual, ...]
    fit: NeedleFit | None


@dataclass(frozen=True, slots=True, kw_only=True)
class ProposedSlice:
    """One likely assignment of the detected needles to the planned ones, for a person to choose.

    Attributes:
        placed: the fit with this assignment.
        found: the detected needles, in the order of the plan.
        probability_ratio: probability 0..1 among the proposals.
        delta_chi2: chi-squared difference to the best other assignment.
    """

    placed: PlacedSlice
    found: tuple[NeedleObservation, ...]
    probability_ratio: float
    delta_chi2: float
