"""One theatre from registration to navigation, with truth and no help from it."""

from collections.abc import Callable, Sequence
from functools import lru_cache, partial

import numpy as np

from tracker.errors import NavigationError
from tracker.navigation import Guide
from tracker.navigation.clearance import field_of_bone
from tracker.plan import Landmark
from tracker.pose import ToolModel
from tracker.registration import AnchoredTo, Registration
from tracker.registration.anchoring import fixed_to_reference
from tracker.rehearsal import Scene, Theatre
from tracker.rehearsal.anatomy import pedicle_channels, vertebra_surface
from tracker.verification.eyes import ANCHORS, Eyes
from tracker.verification.navigating import moved_looks, operation_looks, rows_of
from tracker.verification.people import calibrated_tool, marked_on_ct
from tracker.verification.registering import (
    Touches,
    by_needles,
    by_points,
    checked,
    reference_beside_needles,
    touched_point,
    touches,
)
from tracker.verification.rows import ImageRow, RegistrationRow, TheatreRows, Variant, Way
from tracker.verification.settings import VerificationSettings

# Far apart, on both sides.
TOUCHED_BESIDE_NEEDLES = (0, 3)

Registrations = dict[tuple[Way, AnchoredTo], Registration]


def theatre_seeds(seed: int, count: int) -> tuple[int, ...]:
    """The theatres that follow from one seed; more of them begin with the same."""
    return tuple(int(one) for one in np.random.SeedSequence(seed).generate_state(count))


def verify_theatre(seed: int, settings: VerificationSettings | None = None) -> TheatreRows:
    """All that one seed gives; the same seed gives the same, in whatever process."""
    settings = settings or VerificationSettings()
    random = np.random.default_rng([seed, 0x56455249])
    eyes = Eyes(seed)
    theatre = eyes.theatre
    tool = calibrated_tool(theatre.tool, settings, random)
    plan = _plan(theatre, settings, random)
    touched = touches(eyes, settings, Scene.LANDMARKS)
    registered, rejected = _registered(eyes, touched, plan, tool, settings, random)
    eyes.register()
    check = touches(eyes, settings, Scene.CHECK)
    place = _check_landmark(theatre, settings, random)
    registrations = [
        _row(seed, key, rejected.get(key, ""), registered, check, place, tool, plan)
        for key in ((way, anchor) for way in Way for anchor in ANCHORS)
    ]
    guide = _guide()
    images: list[ImageRow] = []
    for camera_moves, looks_at in ((False, operation_looks), (True, moved_looks)):
        operation = looks_at(eyes, settings, random)
        for (way, anchor), registration in registered.items():
            variant = Variant(way=way, anchored_to=anchor, camera_moves=camera_moves)
            images += rows_of(
                operation,
                registration,
                variant,
                eyes=eyes,
                tool=tool,
                guide=guide,
                seed=seed,
            )
    return TheatreRows(seed=seed, registrations=tuple(registrations), images=tuple(images))


def _plan(
    theatre: Theatre, settings: VerificationSettings, random: np.random.Generator
) -> tuple[Landmark, ...]:
    points = np.stack([one.point_in_vertebra_mm for one in theatre.landmarks])
    marked = marked_on_ct(points, settings.marking_sd_mm, random)
    return tuple(
        Landmark(name=one.name, point_lps_mm=at) for one, at in zip(theatre.landmarks, marked, strict=True)
    )


def _check_landmark(
    theatre: Theatre, settings: VerificationSettings, random: np.random.Generator
) -> Landmark:
    true = theatre.check_landmark
    at = marked_on_ct(true.point_in_vertebra_mm, settings.marking_sd_mm, random)
    return Landmark(name=true.name, point_lps_mm=at)


def _registered(
    eyes: Eyes,
    touched: Touches,
    plan: Sequence[Landmark],
    tool: ToolModel,
    settings: VerificationSettings,
    random: np.random.Generator,
) -> tuple[Registrations, dict[tuple[Way, AnchoredTo], str]]:
    """What each way gives, and the codes of what was refused."""
    channel = eyes.theatre.channels[0]
    found: Registrations = {}
    rejected: dict[tuple[Way, AnchoredTo], str] = {}

    def attempt(way: Way, anchor: AnchoredTo, make: Callable[[], Registration]) -> None:
        try:
            found[way, anchor] = make()
        except NavigationError as rejection:
            rejected[way, anchor] = rejection.code

    for anchor in ANCHORS:
        attempt(Way.POINTS, anchor, partial(by_points, touched, plan, tool, anchor, channel))
    for way, beside in ((Way.NEEDLES, ()), (Way.NEEDLES_TOUCHED, TOUCHED_BESIDE_NEEDLES)):
        # The same needles for both, so that they can be compared.
        state = random.bit_generator.state

        def needles(chosen: tuple[int, ...] = beside) -> Registration:
            tips = [touched_point(touched[plan[i].name], plan[i], tool, settings) for i in chosen]
            return by_needles(eyes, tips, settings, random).registration

        attempt(way, AnchoredTo.CAMERA, needles)
        random.bit_generator.state = state
        if (way, AnchoredTo.CAMERA) in rejected:
            rejected[way, AnchoredTo.REFERENCE] = rejected[way, AnchoredTo.CAMERA]
            continue
        made = found[way, AnchoredTo.CAMERA]
        attempt(way, AnchoredTo.REFERENCE, partial(_beside_reference, made, eyes))
    return found, rejected


def _beside_reference(made: Registration, eyes: Eyes) -> Registration:
    return fixed_to_reference(made, reference_beside_needles(eyes))


def _row(
    seed: int,
    key: tuple[Way, AnchoredTo],
    rejected: str,
    registered: Registrations,
    check: Touches,
    place: Landmark,
    tool: ToolModel,
    plan: Sequence[Landmark],
) -> RegistrationRow:
    distance_mm, passed = np.nan, False
    if key in registered:
        try:
            result = checked(registered[key], check[place.name], place, tool, plan)
            distance_mm, passed = result.distance_mm, result.passed
        except NavigationError:
            # The tip was not seen on it: nothing is let on, and nothing was measured.
            passed = False
    return RegistrationRow(
        seed=seed,
        way=key[0],
        anchored_to=key[1],
        rejected=rejected,
        check_mm=distance_mm,
        check_passed=passed,
    )


@lru_cache(maxsize=1)
def _guide() -> Guide:
    """The bone is the same in all theatres."""
    [channel, _] = pedicle_channels()
    return Guide(wall=field_of_bone(vertebra_surface(), channel))
