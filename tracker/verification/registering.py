"""Registration in the theatre: by landmarks that the tip touches, and by needles in the image."""

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
    places_at_landmarks,
    register_needles,
    view_from_ruler,
)
from tracker.registration.points import PointGate, register_points
from tracker.registration.tip import pairs_of_touches, tip_in_anchor
from tracker.rehearsal import Scene, Theatre
from tracker.verification.eyes import Eyes, Look
from tracker.verification.people import clicked, marked_on_ct, measured_by_ruler, needle_entries
from tracker.verification.settings import VerificationSettings

# From when a hand is at rest after it has come down on a landmark.
SETTLED_S = 0.3
SEARCHED_S = 0.02
# In the scene of the operation: the drill is out of the picture.
NOTHING_BEFORE_NEEDLES_S = 33.5

Touches = Mapping[str, Sequence[Look]]


def touches(eyes: Eyes, settings: VerificationSettings, scene: Scene) -> Touches:
    """Images of the tip at rest, by the name of the landmark."""
    theatre = eyes.scene(scene)
    times = [
        start_s + SETTLED_S + number / settings.image_hz
        for start_s in _touched_from_s(theatre)
        for number in range(settings.capture_images)
    ]
    found: dict[str, list[Look]] = {}
    for look in eyes.looks(theatre, times):
        found.setdefault(look.touched, []).append(look)
    return found


def _touched_from_s(theatre: Theatre) -> list[float]:
    """When the tip comes down on each landmark of a scene."""
    times = np.arange(0.0, theatre.cycle_s, SEARCHED_S)
    names = [theatre.truth_at(float(time)).touched for time in times]
    starts = [number for number in range(1, len(names)) if names[number] and not names[number - 1]]
    return [float(times[number]) for number in starts]


def tip_on(looks: Sequence[Look], tool: ToolModel, anchor: AnchoredTo) -> CapturedLandmark:
    """The tip on a landmark, as the gate of a capture takes it. Raises as `captured`."""
    return captured([_sample(look, tool, anchor) for look in looks])


def _sample(look: Look, tool: ToolModel, anchor: AnchoredTo) -> TipSample | UnseenSample:
    drill, reference = look.sightings[tool.marker], look.sightings["reference"]
    if not isinstance(drill, Seen):
        return UnseenSample(at_s=look.at_s, reason="MARKER_UNSEEN")
    if anchor is AnchoredTo.CAMERA:
        return tip_in_anchor(tool, drill, None, at_s=look.at_s)
    if not isinstance(reference, Seen):
        return UnseenSample(at_s=look.at_s, reason="REFERENCE_UNSEEN")
    return tip_in_anchor(tool, drill, reference, at_s=look.at_s)


def by_points(
    touched: Touches, plan: Sequence[Landmark], tool: ToolModel, anchor: AnchoredTo, channel: Channel
) -> Registration:
    """From all landmarks of the plan, through its gate.

    Raises:
        RegistrationError: a capture, the fit or the gate refuses.
    """
    taken = [tip_on(touched[one.name], tool, anchor) for one in plan]
    fit = register_points(
        pairs_of_touches(
            [one.point_lps_mm for one in plan], taken, labels=[one.name for one in plan], tool=tool.name
        )
    )
    failures = fit.failures(PointGate(), [channel.entry_in_vertebra_mm, channel.target_in_vertebra_mm])
    for failure in failures:
        raise failure
    return fit.registration(anchor)


def by_needles(
    eyes: Eyes,
    touched: Sequence[TouchedPoint],
    settings: VerificationSettings,
    random: np.random.Generator,
) -> NeedleFit:
    """From three needles that somebody marks in an image, a ruler, and points that the tip was held on.

    Raises:
        NavigationError: the fit is refused.
    """
    theatre = eyes.theatre
    points = marked_on_ct(needle_entries(theatre.needles), settings.placing_sd_mm, random)
    names = [f"needle {number + 1}" for number in range(len(points))]
    plan = [Landmark(name=name, point_lps_mm=at) for name, at in zip(names, points, strict=True)]
    seen = [clicked(theatre, needle, settings, random) for needle in theatre.needles]
    measured = measured_by_ruler(theatre, points.mean(axis=0), random)
    at_px = np.mean([one.entry_px for one in seen], axis=0)
    view = view_from_ruler(measured, theatre.camera, at_px, touched=tuple(touched))
    places = places_at_landmarks(plan, placing_sd_mm=settings.placing_sd_mm)
    return register_needles(places, seen, theatre.camera, view)


def touched_point(
    looks: Sequence[Look], landmark: Landmark, tool: ToolModel, settings: VerificationSettings
) -> TouchedPoint:
    """A landmark that the tip was held on, for a registration by needles. Raises as `captured`."""
    tip = tip_on(looks, tool, AnchoredTo.CAMERA)
    return TouchedPoint(
        name=landmark.name,
        point_lps_mm=landmark.point_lps_mm,
        point_in_camera_mm=tip.tip_in_anchor_mm,
        covariance_mm2=tip.covariance_mm2 + settings.marking_sd_mm**2 * np.eye(3),
    )


def reference_beside_needles(eyes: Eyes) -> Seen:
    """The reference in the image in which the needles are marked, without a drill before them.

    Raises:
        RegistrationError: it is not seen.
    """
    [look] = eyes.looks(eyes.scene(Scene.OPERATION), [NOTHING_BEFORE_NEEDLES_S])
    reference = look.sightings["reference"]
    if isinstance(reference, Seen):
        return reference
    raise RegistrationError(
        "REFERENCE_UNSEEN", "the reference is not seen", "Turn it to the camera, and register again."
    )


def checked(
    registration: Registration,
    looks: Sequence[Look],
    landmark: Landmark,
    tool: ToolModel,
    used: Sequence[Landmark],
) -> LandmarkCheck:
    """The tip on a landmark that was not used. Raises as `captured` and `check_landmark`."""
    tip = tip_on(looks, tool, registration.anchored_to)
    return check_landmark(
        registration,
        landmark.name,
        landmark.point_lps_mm,
        tip.tip_in_anchor_mm,
        used_mm={one.name: one.point_lps_mm for one in used} if registration.method is Method.POINTS else {},
        tip_covariance_mm2=tip.covariance_mm2,
    )
