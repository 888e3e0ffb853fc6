"""Simulated registrations: by landmarks captured with the tip, and by needles marked in the image."""

from collections.abc import Mapping, Sequence

import numpy as np

from tracker.errors import RegistrationError
from tracker.plan import Channel, Landmark
from tracker.pose import Seen, ToolModel
from tracker.registration import AnchoredTo, Method, Registration
from tracker.registration.capture import CapturedLandmark, TipSample, UnseenSample, captured
from tracker.registration.check import LandmarkCheck, check_landmark
from tracker.registration.needles import (
    NeedleFit,
    TouchedPoint,
    planned_at_landmarks,
    register_needles,
    view_prior_from_ruler,
)
from tracker.registration.points import PointGate, register_points
from tracker.registration.tip import pairs_of_touches, tip_in_anchor
from tracker.rehearsal import Scene, Theatre
from tracker.verification.observer import Observation, TheatreObserver
from tracker.verification.settings import VerificationSettings
from tracker.verification.user_errors import mark_needle, mark_on_ct, measure_by_ruler, needle_entries

# Time from contact with a landmark until the hand is at rest.
SETTLED_S = 0.3
SEARCH_STEP_S = 0.02
# Time in the operation scene at which the drill is outside the image.
NEEDLES_VISIBLE_S = 33.5

Captures = Mapping[str, Sequence[Observation]]


def capture_landmarks(observer: TheatreObserver, settings: VerificationSettings, scene: Scene) -> Captures:
    """Return the observations of the resting tip, by landmark name."""
    theatre = observer.scene(scene)
    times = [
        start_s + SETTLED_S + number / settings.image_hz
        for start_s in _contact_starts_s(theatre)
        for number in range(settings.capture_images)
    ]
    found: dict[str, list[Observation]] = {}
    for observation in observer.observations(theatre, times):
        found.setdefault(observation.touched, []).append(observation)
    return found


def _contact_starts_s(theatre: Theatre) -> list[float]:
    """Return the times at which the tip reaches each landmark of a scene."""
    times = np.arange(0.0, theatre.cycle_s, SEARCH_STEP_S)
    names = [theatre.truth_at(float(time)).touched for time in times]
    starts = [number for number in range(1, len(names)) if names[number] and not names[number - 1]]
    return [float(times[number]) for number in starts]


def capture_tip(observations: Sequence[Observation], tool: ToolModel, anchor: AnchoredTo) -> CapturedLandmark:
    """Return the captured tip on a landmark, through the capture gate. Raises as `captured`."""
    return captured([_sample(observation, tool, anchor) for observation in observations])


def _sample(observation: Observation, tool: ToolModel, anchor: AnchoredTo) -> TipSample | UnseenSample:
    drill, reference = observation.sightings[tool.marker], observation.sightings["reference"]
    if not isinstance(drill, Seen):
        return UnseenSample(at_s=observation.at_s, reason="MARKER_UNSEEN")
    if anchor is AnchoredTo.CAMERA:
        return tip_in_anchor(tool, drill, None, at_s=observation.at_s)
    if not isinstance(reference, Seen):
        return UnseenSample(at_s=observation.at_s, reason="REFERENCE_UNSEEN")
    return tip_in_anchor(tool, drill, reference, at_s=observation.at_s)


def register_by_points(
    touched: Captures, plan: Sequence[Landmark], tool: ToolModel, anchor: AnchoredTo, channel: Channel
) -> Registration:
    """Return the registration from all landmarks of the plan, through the point gate.

    Raises:
        RegistrationError: a capture, the fit or the gate rejects it.
    """
    taken = [capture_tip(touched[one.name], tool, anchor) for one in plan]
    fit = register_points(
        pairs_of_touches(
            [one.point_lps_mm for one in plan], taken, labels=[one.name for one in plan], tool=tool.name
        )
    )
    failures = fit.failures(PointGate(), [channel.entry_in_vertebra_mm, channel.target_in_vertebra_mm])
    for failure in failures:
        raise failure
    return fit.registration(anchor)


def register_by_needles(
    observer: TheatreObserver,
    touched: Sequence[TouchedPoint],
    settings: VerificationSettings,
    random: np.random.Generator,
) -> NeedleFit:
    """Return the fit to three needles marked in an image, a ruler reading and captured points.

    Raises:
        NavigationError: the fit is rejected.
    """
    theatre = observer.theatre
    points = mark_on_ct(needle_entries(theatre.needles), settings.placing_sd_mm, random)
    names = [f"needle {number + 1}" for number in range(len(points))]
    plan = [Landmark(name=name, point_lps_mm=at) for name, at in zip(names, points, strict=True)]
    seen = [mark_needle(theatre, needle, settings, random) for needle in theatre.needles]
    measured = measure_by_ruler(theatre, points.mean(axis=0), random)
    at_px = np.mean([one.entry_px for one in seen], axis=0)
    view = view_prior_from_ruler(measured, theatre.camera, at_px, touched=tuple(touched))
    places = planned_at_landmarks(plan, placing_sd_mm=settings.placing_sd_mm)
    return register_needles(places, seen, theatre.camera, view)


def captured_point(
    observations: Sequence[Observation], landmark: Landmark, tool: ToolModel, settings: VerificationSettings
) -> TouchedPoint:
    """Return a landmark captured with the tip, for a needle registration. Raises as `captured`."""
    tip = capture_tip(observations, tool, AnchoredTo.CAMERA)
    return TouchedPoint(
        name=landmark.name,
        point_lps_mm=landmark.point_lps_mm,
        point_in_camera_mm=tip.tip_in_anchor_mm,
        covariance_mm2=tip.covariance_mm2 + settings.marking_sd_mm**2 * np.eye(3),
    )


def reference_beside_needles(observer: TheatreObserver) -> Seen:
    """Return the reference detected in the image of the needles, where the drill does not occlude it.

    Raises:
        RegistrationError: the reference is not detected.
    """
    [observation] = observer.observations(observer.scene(Scene.OPERATION), [NEEDLES_VISIBLE_S])
    reference = observation.sightings["reference"]
    if isinstance(reference, Seen):
        return reference
    raise RegistrationError(
        "REFERENCE_UNSEEN", "the reference is not seen", "Turn it to the camera, and register again."
    )


def check_registration(
    registration: Registration,
    observations: Sequence[Observation],
    landmark: Landmark,
    tool: ToolModel,
    used: Sequence[Landmark],
) -> LandmarkCheck:
    """Check a registration on an unused landmark. Raises as `captured` and `check_landmark`."""
    tip = capture_tip(observations, tool, registration.anchored_to)
    return check_landmark(
        registration,
        landmark.name,
        landmark.point_lps_mm,
        tip.tip_in_anchor_mm,
        used_mm={one.name: one.point_lps_mm for one in used} if registration.method is Method.POINTS else {},
        tip_covariance_mm2=tip.covariance_mm2,
    )
