"""Verification of one theatre, from registration to navigation, without use of the ground truth."""

from collections.abc import Callable, Sequence
from functools import lru_cache, partial

import numpy as np

from tracker.errors import NavigationError
from tracker.navigation import DrillReference
from tracker.navigation.clearance import bone_distance_field
from tracker.plan import Channel, Landmark
from tracker.pose import ToolModel
from tracker.registration import AnchoredTo, Registration
from tracker.registration.anchoring import anchor_to_reference
from tracker.rehearsal import Scene, Theatre
from tracker.rehearsal.anatomy import pedicle_channels, vertebra_surface
from tracker.verification.navigation_runs import image_rows, operation_with_camera_move, undisturbed_operation
from tracker.verification.observer import ANCHORS, TheatreObserver
from tracker.verification.registration_runs import (
    Captures,
    capture_landmarks,
    captured_point,
    check_registration,
    reference_beside_needles,
    register_by_needles,
    register_by_points,
)
from tracker.verification.rows import ImageRow, RegistrationMethod, RegistrationRow, TheatreRows, Variant
from tracker.verification.settings import VerificationSettings
from tracker.verification.user_errors import calibrated_tool, mark_on_ct

# Indices of two landmarks far apart, on both sides.
CAPTURED_WITH_NEEDLES = (0, 3)

Registrations = dict[tuple[RegistrationMethod, AnchoredTo], Registration]


def theatre_seeds(seed: int, count: int) -> tuple[int, ...]:
    """Return theatre seeds derived from one seed; a longer list begins with the shorter one."""
    return tuple(int(one) for one in np.random.SeedSequence(seed).generate_state(count))


def verify_theatre(seed: int, settings: VerificationSettings | None = None) -> TheatreRows:
    """Return all results of one seed. The result is deterministic, also across processes."""
    settings = settings or VerificationSettings()
    random = np.random.default_rng([seed, 0x56455249])
    observer = TheatreObserver(seed)
    theatre = observer.theatre
    tool = calibrated_tool(theatre.tool, settings, random)
    plan = _plan(theatre, settings, random)
    touched = capture_landmarks(observer, settings, Scene.LANDMARKS)
    registered, rejected = _registered(observer, touched, plan, tool, settings, random)
    observer.register()
    check = capture_landmarks(observer, settings, Scene.CHECK)
    place = _check_landmark(theatre, settings, random)
    registrations = [
        _row(seed, key, rejected.get(key, ""), registered, check, place, tool, plan)
        for key in ((method, anchor) for method in RegistrationMethod for anchor in ANCHORS)
    ]
    drill_reference = _guide()
    images: list[ImageRow] = []
    for camera_moves, looks_at in ((False, undisturbed_operation), (True, operation_with_camera_move)):
        operation = looks_at(observer, settings, random)
        for (method, anchor), registration in registered.items():
            variant = Variant(method=method, anchored_to=anchor, camera_moves=camera_moves)
            images += image_rows(
                operation,
                registration,
                variant,
                observer=observer,
                tool=tool,
                drill_reference=drill_reference,
                seed=seed,
            )
    return TheatreRows(seed=seed, registrations=tuple(registrations), images=tuple(images))


def _plan(
    theatre: Theatre, settings: VerificationSettings, random: np.random.Generator
) -> tuple[Landmark, ...]:
    points = np.stack([one.point_in_vertebra_mm for one in theatre.landmarks])
    marked = mark_on_ct(points, settings.marking_sd_mm, random)
    return tuple(
        Landmark(name=one.name, point_lps_mm=at) for one, at in zip(theatre.landmarks, marked, strict=True)
    )


def _check_landmark(
    theatre: Theatre, settings: VerificationSettings, random: np.random.Generator
) -> Landmark:
    true = theatre.check_landmark
    at = mark_on_ct(true.point_in_vertebra_mm, settings.marking_sd_mm, random)
    return Landmark(name=true.name, point_lps_mm=at)


def _registered(
    observer: TheatreObserver,
    touched: Captures,
    plan: Sequence[Landmark],
    tool: ToolModel,
    settings: VerificationSettings,
    random: np.random.Generator,
) -> tuple[Registrations, dict[tuple[RegistrationMethod, AnchoredTo], str]]:
    """Return the registration of each method, and the error codes of those that were rejected."""
    channel = observer.theatre.channels[0]
    found: Registrations = {}
    rejected: dict[tuple[RegistrationMethod, AnchoredTo], str] = {}

    def attempt(method: RegistrationMethod, anchor: AnchoredTo, make: Callable[[], Registration]) -> None:
        try:
            found[method, anchor] = make()
        except NavigationError as rejection:
            rejected[method, anchor] = rejection.code

    for anchor in ANCHORS:
        attempt(
            RegistrationMethod.POINTS,
            anchor,
            partial(register_by_points, touched, plan, tool, anchor, channel),
        )
    for method, beside in (
        (RegistrationMethod.NEEDLES, ()),
        (RegistrationMethod.NEEDLES_TOUCHED, CAPTURED_WITH_NEEDLES),
    ):
        # Both methods use the same needles, so that they can be compared.
        state = random.bit_generator.state

        def needles(chosen: tuple[int, ...] = beside) -> Registration:
            tips = [captured_point(touched[plan[i].name], plan[i], tool, settings) for i in chosen]
            return register_by_needles(observer, tips, settings, random).registration

        attempt(method, AnchoredTo.CAMERA, needles)
        random.bit_generator.state = state
        if (method, AnchoredTo.CAMERA) in rejected:
            rejected[method, AnchoredTo.REFERENCE] = rejected[method, AnchoredTo.CAMERA]
            continue
        made = found[method, AnchoredTo.CAMERA]
        attempt(method, AnchoredTo.REFERENCE, partial(_beside_reference, made, observer, channel))
    return found, rejected


def _beside_reference(made: Registration, observer: TheatreObserver, channel: Channel) -> Registration:
    reference = reference_beside_needles(observer)
    return anchor_to_reference(made, reference, at_in_vertebra_mm=channel.entry_in_vertebra_mm)


def _row(
    seed: int,
    key: tuple[RegistrationMethod, AnchoredTo],
    rejected: str,
    registered: Registrations,
    check: Captures,
    place: Landmark,
    tool: ToolModel,
    plan: Sequence[Landmark],
) -> RegistrationRow:
    distance_mm, passed = np.nan, False
    if key in registered:
        try:
            result = check_registration(registered[key], check[place.name], place, tool, plan)
            distance_mm, passed = result.distance_mm, result.passed
        except NavigationError:
            # Without an accepted capture there is no distance, and navigation is not permitted.
            passed = False
    return RegistrationRow(
        seed=seed,
        method=key[0],
        anchored_to=key[1],
        rejected=rejected,
        check_mm=distance_mm,
        check_passed=passed,
    )


@lru_cache(maxsize=1)
def _guide() -> DrillReference:
    """Return the drill reference along the left channel; the bone is the same in all theatres."""
    [channel, _] = pedicle_channels()
    return DrillReference(wall=bone_distance_field(vertebra_surface(), channel))
