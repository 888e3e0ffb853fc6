"""Needle registration step: registers the plan by three needles in the live image, as in the paper."""

from collections.abc import Sequence

import numpy as np

from server.errors import CaptureError
from server.live import LiveHub
from server.procedure.images_in_use import reject_without_images
from server.procedure.registration.context import RegistrationContext, RegistrationContextFinder
from server.procedure.registration.needle_records import (
    NeedleRequest,
    NeedleScene,
    PlacedSlice,
    ProposedSlice,
)
from server.procedure.registration.repository import RegistrationRepository
from server.procedure.registration_record import RegistrationEvidence, Value
from server.store import Document
from tracker.errors import CalibrationError, InvalidInput, PlanError, RegistrationError
from tracker.geometry import Camera, Rigid, Vertebra
from tracker.plan import ReferenceSlice
from tracker.pose import Seen
from tracker.registration.anchoring import anchor_to_reference
from tracker.registration.needles import (
    NeedleFit,
    NeedleObservation,
    SliceOverlay,
    TouchedPoint,
    first_overlay,
    needles_from_overlay,
    overlay_lines_px,
    overlay_of_pose,
    overlay_residuals,
    planned_at_landmarks,
    planned_on_lines,
    pose_of_overlay,
    propose_needles,
    refine_marked,
    register_needles,
)


class NeedleStep:
    """Registers by needles in the newest image. Stateless and thread-safe.

    Args:
        hub: the live images.
        contexts: finds the context of the registration.
        repository: where it is stored.
    """

    def __init__(
        self, *, hub: LiveHub, contexts: RegistrationContextFinder, repository: RegistrationRepository
    ) -> None:
        self._hub = hub
        self._contexts = contexts
        self._repository = repository

    def scene(self, order: NeedleRequest, touched: tuple[TouchedPoint, ...] = ()) -> NeedleScene:
        """Return the newest image with the planned needles.

        Raises:
            SetupOrderError: NO_CASE_OPEN, NO_CAMERA_IN_USE, or the code of a missing earlier step.
            PlanError: VERTEBRA_UNKNOWN, LANDMARK_UNKNOWN, REFERENCE_MISSING.
            CaptureError: NO_PICTURE.
            CalibrationError: CAMERA_NOT_CALIBRATED.
        """
        reject_without_images(self._hub)
        context = self._contexts.find(vertebra=order.vertebra, tool=None)
        newest = self._hub.newest
        if newest is None or newest.image is None or newest.snapshot is None:
            raise CaptureError(
                "NO_PICTURE",
                "there is no image in which needles could be detected",
                "Wait until the video runs, and try again.",
            )
        setup = newest.snapshot.setup
        if not setup.camera_calibrated:
            raise CalibrationError(
                "CAMERA_NOT_CALIBRATED",
                "the camera is not calibrated, so that needles cannot be measured in mm",
                "Calibrate the camera first, or set camera.calibration to its file.",
            )
        reference = None if order.landmarks else _reference(context)
        places = (
            planned_at_landmarks([context.landmark(name) for name in order.landmarks])
            if reference is None
            else planned_on_lines(reference)
        )
        return NeedleScene(
            context=context,
            places=places,
            reference=reference,
            camera=setup.camera,
            image=newest.image,
            snapshot=newest.snapshot,
            measured=order.measured,
            touched=touched,
        )

    def propose(self, scene: NeedleScene, *, radius_mm: float) -> tuple[ProposedSlice, ...]:
        """Detect the needles, and place the slice for each likely assignment; nothing is stored.

        Raises:
            RegistrationError: NEEDLES_NOT_FOUND, or as `register_needles` if no assignment fits.
        """
        proposals = propose_needles(
            scene.image,
            scene.places,
            scene.camera,
            scene.measured,
            touched=scene.touched,
            radius_mm=radius_mm,
        )
        out = []
        for one in proposals:
            seen = tuple(needle.seen for needle in one.needles)
            placed = _fitted(scene, one.fit, seen)
            out.append(
                ProposedSlice(
                    placed=placed,
                    found=seen,
                    probability_ratio=one.probability_ratio,
                    delta_chi2=one.delta_chi2,
                )
            )
        return tuple(out)

    def mark(
        self, scene: NeedleScene, marked: Sequence[NeedleObservation], *, order_is_sure: bool = False
    ) -> PlacedSlice:
        """Fit to needles that a person has marked, in the order of the plan; nothing is stored.

        Args:
            scene: the image with the planned needles.
            marked: the marked needles.
            order_is_sure: whether the person chose this assignment among alternatives in the image.

        Raises:
            InvalidInput: NEEDLES_UNPAIRED.
            RegistrationError: as `register_needles`.
        """
        if len(marked) != len(scene.places):
            needles = ", ".join(place.name for place in scene.places)
            raise InvalidInput(
                "NEEDLES_UNPAIRED",
                f"{len(marked)} needles are marked, but {len(scene.places)} are planned",
                f"Mark one needle each for {needles}, in this order.",
                {"marked": len(marked), "planned": len(scene.places), "needles": needles},
            )
        seen = refine_marked(scene.image, scene.camera, marked)
        at_px = np.mean([one.entry_px for one in seen], axis=0)
        view = scene.view(at_px)
        fit = register_needles(scene.places, seen, scene.camera, view, order_is_sure=order_is_sure)
        return _fitted(scene, fit, seen)

    def lay(
        self, scene: NeedleScene, overlay: SliceOverlay | None, marked: Sequence[NeedleObservation] = ()
    ) -> PlacedSlice:
        """Place the slice by the given overlay, or by the ruler measurement; nothing is fitted or stored."""
        at_px = None if overlay is None else overlay.shift_px
        view = scene.view(at_px)
        placed = overlay or first_overlay(scene.places, scene.camera, view)
        pose = pose_of_overlay(placed, scene.places, scene.camera, view)
        return PlacedSlice(
            scene=scene,
            overlay=placed,
            camera_from_vertebra=pose,
            lines_px=overlay_lines_px(pose, scene.places, scene.camera),
            residuals=overlay_residuals(pose, scene.places, marked, scene.camera) if marked else (),
            fit=None,
        )

    def take(self, scene: NeedleScene, overlay: SliceOverlay) -> PlacedSlice:
        """Fit to the needles under the lines of a manually placed overlay; nothing is stored.

        Raises:
            RegistrationError: as `register_needles`.
        """
        placed = self.lay(scene, overlay)
        seen = needles_from_overlay(placed.camera_from_vertebra, scene.places, scene.camera)
        fit = register_needles(
            scene.places, seen, scene.camera, scene.view(overlay.shift_px), order_is_sure=True
        )
        return _fitted(scene, fit, seen)

    def keep(self, placed: PlacedSlice, *, way: str, made_by: str) -> Document:
        """Store a fit in the open case as the registration of its vertebra.

        Raises:
            SetupOrderError, OutOfDateError: A dependency is missing or has changed.
            RegistrationError: NEEDLES_NOT_FITTED, REFERENCE_UNSEEN.
        """
        fit, scene = placed.fit, placed.scene
        if fit is None:
            raise RegistrationError(
                "NEEDLES_NOT_FITTED", "the slice was placed without a fit", "Fit the overlay first."
            )
        self._contexts.reject_changed(scene.context)
        registration = fit.registration
        if scene.context.reference:
            beside = scene.snapshot.sightings.get(scene.context.reference)
            if not isinstance(beside, Seen):
                raise RegistrationError(
                    "REFERENCE_UNSEEN",
                    f"the marker '{scene.context.reference}' on the patient is not seen in this image",
                    "Clear the view of the marker on the patient, and register again.",
                    {"reference": scene.context.reference},
                )
            # Of a vertebra without a channel, the needles lie where one would begin.
            near = scene.context.entries_mm or tuple(one.point_lps_mm for one in scene.places)
            registration = anchor_to_reference(registration, beside, at_in_vertebra_mm=np.mean(near, axis=0))
        return self._repository.put(
            scene.context,
            registration,
            RegistrationEvidence(
                numbers=numbers_of(placed, fit),
                made_from=_made_from(placed, fit, way),
                from_s=scene.snapshot.captured_at_s,
            ),
            made_by=made_by,
        )


def numbers_of(placed: PlacedSlice, fit: NeedleFit) -> dict[str, Value]:
    """Return the results of the fit by name, with standard deviations."""
    entries = [
        float(np.sqrt(np.trace(fit.registration.point_covariance_mm2(entry))))
        for entry in placed.scene.context.entries_mm
    ]
    return {
        "needles": len(fit.residuals),
        "worst_offset_px": max(abs(one.offset_px) for one in fit.residuals),
        "worst_offset_mm": max(abs(one.offset_mm) for one in fit.residuals),
        "chi2": fit.chi2,
        "freedom": fit.freedom,
        "depth_sd_mm": fit.observability.depth.sd,
        "across_sd_mm": fit.observability.across.sd,
        "tilt_sd_deg": fit.observability.tilt.sd,
        "turn_sd_deg": fit.observability.turn.sd,
        "tre_at_entry_mm": max(entries, default=None),
    }


def _fitted(scene: NeedleScene, fit: NeedleFit, seen: Sequence[NeedleObservation]) -> PlacedSlice:
    fixed = fit.registration.anchor_from_vertebra
    pose: Rigid[Camera, Vertebra] = Rigid(rotation=fixed.rotation, translation_mm=fixed.translation_mm)
    at_px = np.mean([one.entry_px for one in seen], axis=0)
    return PlacedSlice(
        scene=scene,
        overlay=overlay_of_pose(pose, scene.places, scene.camera, scene.view(at_px)),
        camera_from_vertebra=pose,
        lines_px=overlay_lines_px(pose, scene.places, scene.camera),
        residuals=overlay_residuals(pose, scene.places, seen, scene.camera),
        fit=fit,
    )


def _made_from(placed: PlacedSlice, fit: NeedleFit, way: str) -> dict[str, object]:
    measured = placed.scene.measured
    return {
        "way": way,
        "view": {
            "vertical_mm": measured.vertical_mm,
            "horizontal_mm": measured.horizontal_mm,
            "azimuth_deg": measured.azimuth_deg,
            "patient_end": measured.patient_end.value,
        },
        # A landmark with a needle cannot verify the registration, like a captured one.
        "points": [
            {"landmark": place.name, "point_lps_mm": place.point_lps_mm.tolist(), "used": True}
            for place in placed.scene.places
            if placed.scene.reference is None
        ],
        "touched": [one.name for one in placed.scene.touched],
        "needles": [
            {
                "name": one.name,
                "offset_px": one.offset_px,
                "offset_mm": one.offset_mm,
                "lean_deg": one.lean_deg,
            }
            for one in fit.residuals
        ],
        "overlay": {
            "shift_px": placed.overlay.shift_px.tolist(),
            "rotation_deg": placed.overlay.rotation_deg,
            "scale_px_per_mm": placed.overlay.scale_px_per_mm,
        },
    }


def _reference(context: RegistrationContext) -> ReferenceSlice:
    if not context.vertebra.references:
        raise PlanError(
            "REFERENCE_MISSING",
            f"{context.vertebra.name} has no reference slice",
            "Select its reference slice in the plan, or give the landmarks at which the needles enter.",
            {"vertebra": context.vertebra.name},
        )
    return context.vertebra.references[0]
