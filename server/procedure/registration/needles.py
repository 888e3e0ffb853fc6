"""The step in which plan and patient are registered by three needles in the live image, as in the paper."""

from collections.abc import Sequence

import numpy as np

from server.errors import CaptureError
from server.live import LiveHub
from server.procedure.registered import Value
from server.procedure.registration.ground import Ground, GroundFinder
from server.procedure.registration.needle_records import LaidSlice, NeedleOrder, NeedleScene, ProposedSlice
from server.procedure.registration.repository import RegistrationRepository
from server.store import Document
from tracker.errors import CalibrationError, InvalidInput, PlanError, RegistrationError
from tracker.geometry import Camera, Rigid, Vertebra
from tracker.plan import ReferenceSlice
from tracker.pose import Seen
from tracker.registration.anchoring import fixed_to_reference
from tracker.registration.needles import (
    NeedleFit,
    NeedleSeen,
    SliceOverlay,
    TouchedPoint,
    first_overlay,
    needles_under,
    overlay_lines_px,
    overlay_of_pose,
    overlay_residuals,
    places_at_landmarks,
    places_on_lines,
    pose_of_overlay,
    propose_needles,
    refine_marked,
    register_needles,
)


class NeedleStep:
    """Registers by needles in the newest image. Safe to use from any thread; holds nothing.

    Args:
        hub: the live images.
        grounds: what a registration is made on.
        shelf: where it is kept.
    """

    def __init__(self, *, hub: LiveHub, grounds: GroundFinder, repository: RegistrationRepository) -> None:
        self._hub = hub
        self._grounds = grounds
        self._repository = repository

    def scene(self, order: NeedleOrder, touched: tuple[TouchedPoint, ...] = ()) -> NeedleScene:
        """The newest image with the needles that are planned to be in it.

        Raises:
            SetupOrderError: NO_CASE_OPEN, or what registration waits for.
            PlanError: VERTEBRA_UNKNOWN, LANDMARK_UNKNOWN, REFERENCE_MISSING.
            CaptureError: NO_PICTURE.
            CalibrationError: CAMERA_NOT_CALIBRATED.
        """
        ground = self._grounds.find(vertebra=order.vertebra, tool=None)
        newest = self._hub.newest
        if newest is None or newest.image is None or newest.snapshot is None:
            raise CaptureError(
                "NO_PICTURE",
                "there is no picture to find needles in",
                "Wait until the video runs, and try again.",
            )
        setup = newest.snapshot.setup
        if not setup.camera_calibrated:
            raise CalibrationError(
                "CAMERA_NOT_CALIBRATED",
                "the camera is not calibrated, so the needles say nothing in millimetres",
                "Calibrate the camera first, or name its file as camera.calibration.",
            )
        reference = None if order.landmarks else _reference(ground)
        places = (
            places_at_landmarks([ground.landmark(name) for name in order.landmarks])
            if reference is None
            else places_on_lines(reference)
        )
        return NeedleScene(
            ground=ground,
            places=places,
            reference=reference,
            camera=setup.camera,
            image=newest.image,
            snapshot=newest.snapshot,
            measured=order.measured,
            touched=touched,
        )

    def propose(self, scene: NeedleScene, *, radius_mm: float) -> tuple[ProposedSlice, ...]:
        """Find the needles in the image, and lay the slice over each likely naming; nothing is kept.

        Raises:
            RegistrationError: NEEDLES_NOT_FOUND, or as `register_needles` where nothing fits.
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
            laid = _fitted(scene, one.fit, seen)
            out.append(
                ProposedSlice(laid=laid, found=seen, probability_ratio=one.probability_ratio, lead=one.lead)
            )
        return tuple(out)

    def mark(
        self, scene: NeedleScene, marked: Sequence[NeedleSeen], *, order_is_sure: bool = False
    ) -> LaidSlice:
        """Fit to needles that a person has marked, each in the order of the plan; nothing is kept.

        Args:
            scene: the image.
            marked: the needles.
            order_is_sure: whether the person has picked this naming in the picture, beside others.

        Raises:
            InvalidInput: NEEDLES_UNPAIRED.
            RegistrationError: as `register_needles`.
        """
        if len(marked) != len(scene.places):
            raise InvalidInput(
                "NEEDLES_UNPAIRED",
                f"{len(marked)} needles are marked, {len(scene.places)} are planned",
                f"Mark one for each of: {', '.join(place.name for place in scene.places)}, in this order.",
                {"marked": len(marked), "planned": len(scene.places)},
            )
        seen = refine_marked(scene.image, scene.camera, marked)
        at_px = np.mean([one.entry_px for one in seen], axis=0)
        view = scene.view(at_px)
        fit = register_needles(scene.places, seen, scene.camera, view, order_is_sure=order_is_sure)
        return _fitted(scene, fit, seen)

    def lay(
        self, scene: NeedleScene, overlay: SliceOverlay | None, marked: Sequence[NeedleSeen] = ()
    ) -> LaidSlice:
        """Lay the slice where a person has it, or where the ruler has it; nothing is fitted or kept."""
        at_px = None if overlay is None else overlay.shift_px
        view = scene.view(at_px)
        laid = overlay or first_overlay(scene.places, scene.camera, view)
        pose = pose_of_overlay(laid, scene.places, scene.camera, view)
        return LaidSlice(
            scene=scene,
            overlay=laid,
            camera_from_vertebra=pose,
            lines_px=overlay_lines_px(pose, scene.places, scene.camera),
            residuals=overlay_residuals(pose, scene.places, marked, scene.camera) if marked else (),
            fit=None,
        )

    def take(self, scene: NeedleScene, overlay: SliceOverlay) -> LaidSlice:
        """Fit to needles that lie where a person has laid the lines over them; nothing is kept.

        Raises:
            RegistrationError: as `register_needles`.
        """
        laid = self.lay(scene, overlay)
        seen = needles_under(laid.camera_from_vertebra, scene.places, scene.camera)
        fit = register_needles(
            scene.places, seen, scene.camera, scene.view(overlay.shift_px), order_is_sure=True
        )
        return _fitted(scene, fit, seen)

    def keep(self, laid: LaidSlice, *, way: str, made_by: str) -> Document:
        """Keep a fit in the open case as the registration of its vertebra.

        Raises:
            SetupOrderError, OutOfDateError: what it stands on is missing, or was changed.
            RegistrationError: NEEDLES_NOT_FITTED, REFERENCE_UNSEEN.
        """
        fit, scene = laid.fit, laid.scene
        if fit is None:
            raise RegistrationError(
                "NEEDLES_NOT_FITTED", "the slice was laid, and nothing was fitted", "Take the overlay first."
            )
        self._grounds.reject_changed(scene.ground)
        registration = fit.registration
        if scene.ground.reference:
            beside = scene.snapshot.sightings.get(scene.ground.reference)
            if not isinstance(beside, Seen):
                raise RegistrationError(
                    "REFERENCE_UNSEEN",
                    f"the marker '{scene.ground.reference}' on the patient is not seen in this image",
                    "Clear the view to the marker on the patient, and register again.",
                    {"reference": scene.ground.reference},
                )
            registration = fixed_to_reference(registration, beside)
        return self._repository.put(
            scene.ground,
            registration,
            numbers=numbers_of(laid, fit),
            made_from=_made_from(laid, fit, way),
            made_by=made_by,
            from_s=scene.snapshot.captured_at_s,
        )


def numbers_of(laid: LaidSlice, fit: NeedleFit) -> dict[str, Value]:
    """The numbers of the fit, what it cannot see among them."""
    entries = [
        float(np.sqrt(np.trace(fit.registration.point_covariance_mm2(entry))))
        for entry in laid.scene.ground.entries_mm
    ]
    return {
        "needles": len(fit.residuals),
        "worst_offset_px": max(abs(one.offset_px) for one in fit.residuals),
        "worst_offset_mm": max(abs(one.offset_mm) for one in fit.residuals),
        "chi2": fit.chi2,
        "freedom": fit.freedom,
        "depth_sd_mm": fit.sureness.depth.sd,
        "across_sd_mm": fit.sureness.across.sd,
        "tilt_sd_deg": fit.sureness.tilt.sd,
        "turn_sd_deg": fit.sureness.turn.sd,
        "tre_at_entry_mm": max(entries, default=None),
    }


def _fitted(scene: NeedleScene, fit: NeedleFit, seen: Sequence[NeedleSeen]) -> LaidSlice:
    fixed = fit.registration.anchor_from_vertebra
    pose: Rigid[Camera, Vertebra] = Rigid(rotation=fixed.rotation, translation_mm=fixed.translation_mm)
    at_px = np.mean([one.entry_px for one in seen], axis=0)
    return LaidSlice(
        scene=scene,
        overlay=overlay_of_pose(pose, scene.places, scene.camera, scene.view(at_px)),
        camera_from_vertebra=pose,
        lines_px=overlay_lines_px(pose, scene.places, scene.camera),
        residuals=overlay_residuals(pose, scene.places, seen, scene.camera),
        fit=fit,
    )


def _made_from(laid: LaidSlice, fit: NeedleFit, way: str) -> dict[str, object]:
    measured = laid.scene.measured
    return {
        "way": way,
        "view": {
            "vertical_mm": measured.vertical_mm,
            "horizontal_mm": measured.horizontal_mm,
            "azimuth_deg": measured.azimuth_deg,
            "standing": measured.standing.value,
        },
        # A needle's landmark says nothing of the registration afterwards, as a touched one does not.
        "points": [
            {"landmark": place.name, "point_lps_mm": place.point_lps_mm.tolist(), "used": True}
            for place in laid.scene.places
            if laid.scene.reference is None
        ],
        "touched": [one.name for one in laid.scene.touched],
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
            "shift_px": laid.overlay.shift_px.tolist(),
            "turn_deg": laid.overlay.turn_deg,
            "scale_px_per_mm": laid.overlay.scale_px_per_mm,
        },
    }


def _reference(ground: Ground) -> ReferenceSlice:
    if not ground.vertebra.references:
        raise PlanError(
            "REFERENCE_MISSING",
            f"{ground.vertebra.name} has no reference slice",
            "Choose the slice that stands for it in the plan, or name "
            "the landmarks that the needles stand on.",
            {"vertebra": ground.vertebra.name},
        )
    return ground.vertebra.references[0]
