"""Simulated operations with a registration: errors of what is displayed, image by image."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tracker.navigation import Absent, AbsentReason, DrillReference, NavigationSnapshot, Setup, navigate
from tracker.navigation.clearance import drill_rings
from tracker.navigation.drill_reference import tool_in_vertebra
from tracker.navigation.uncertainty import UncertainPose
from tracker.plan import Channel
from tracker.pose import Seen, ToolModel
from tracker.registration import AnchoredTo, Registration
from tracker.rehearsal import Event, EventKind, Scene
from tracker.verification.observer import Observation, TheatreObserver
from tracker.verification.rows import ImageRow, Variant
from tracker.verification.settings import VerificationSettings
from tracker.verification.tool_errors import ToolErrors, tool_errors

# Interval in which the drill is in view and near the bone.
FROM_S, TO_S = 1.5, 30.0
BEFORE_MOVE_S = (0.5, 0.9)
MOVE_MM, MOVE_DEG = (3.0, 20.0), (0.5, 3.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Operation:
    """Observations of one operation.

    Attributes:
        observations: all images.
        counting_s: times of the images that enter the statistics.
        moves_at_s: time at which the camera is moved; infinite without a move.
    """

    observations: tuple[Observation, ...]
    counting_s: frozenset[float]
    moves_at_s: float


def undisturbed_operation(
    observer: TheatreObserver, settings: VerificationSettings, random: np.random.Generator
) -> "Operation":
    """Return an operation without events."""
    counting = _spread_over(FROM_S, TO_S, settings.observations, random)
    observations = observer.observations(observer.scene(Scene.OPERATION), _bursts(counting, settings))
    return Operation(observations=tuple(observations), counting_s=frozenset(counting), moves_at_s=np.inf)


def operation_with_camera_move(
    observer: TheatreObserver, settings: VerificationSettings, random: np.random.Generator
) -> "Operation":
    """Return an operation in which the camera is moved halfway."""
    at_s = settings.moves_at_s + random.uniform(0.0, 1.0)
    move = Event(
        kind=EventKind.CAMERA_MOVES,
        at_s=at_s,
        size_mm=random.uniform(*MOVE_MM),
        size_deg=random.uniform(*MOVE_DEG),
    )
    before = _bursts([FROM_S + 4.0, FROM_S + 9.0], settings)
    counting = _spread_over(
        at_s + settings.observed_after_move_s + 0.5, TO_S, settings.observations // 2, random
    )
    # The phase of the move relative to the image interval must be random.
    from_s = at_s - random.uniform(*BEFORE_MOVE_S)
    around = np.arange(from_s, at_s + settings.observed_after_move_s, 1.0 / settings.image_hz).tolist()
    times = [*before, *around, *_bursts(counting, settings)]
    observations = observer.observations(observer.scene(Scene.OPERATION, (move,)), times)
    return Operation(observations=tuple(observations), counting_s=frozenset(counting), moves_at_s=at_s)


def image_rows(
    operation: Operation,
    registration: Registration,
    variant: Variant,
    *,
    observer: TheatreObserver,
    tool: ToolModel,
    drill_reference: DrillReference,
    seed: int,
) -> list[ImageRow]:
    """Return a row for each counting image and for each image after the camera was moved."""
    channel = observer.theatre.channels[0]
    setup = Setup(
        camera=observer.theatre.camera,
        camera_calibrated=True,
        tools={tool.name: tool},
        channel=channel,
        registration=registration,
        reference="reference" if variant.anchored_to is AnchoredTo.REFERENCE else "",
    )
    rows = []
    for observation in operation.observations:
        since_s = observation.at_s - operation.moves_at_s
        counts = observation.at_s in operation.counting_s
        if not counts and since_s < 0.0:
            continue
        snapshot = _snapshot(setup, observation, variant.anchored_to, drill_reference if counts else None)
        absent, off = _compare_with_truth(snapshot, observation, tool, channel)
        judged = snapshot.analyses[tool.name]
        rows.append(
            ImageRow(
                seed=seed,
                variant=variant,
                at_s=observation.at_s,
                phase=observation.phase,
                counts=counts,
                since_move_s=since_s,
                absent=absent,
                tool_errors=off,
                is_through=counts and _is_through(observation, tool, drill_reference, channel),
                through_ratio=np.nan if isinstance(judged, Absent) else judged.now.through_ratio,
            )
        )
    return rows


def _snapshot(
    setup: Setup, observation: Observation, anchor: AnchoredTo, drill_reference: DrillReference | None
) -> NavigationSnapshot:
    return navigate(
        setup=setup,
        sightings=observation.sightings_for(anchor),
        image_number=0,
        captured_at_s=observation.at_s,
        size_wh_px=setup.camera.size_wh_px,
        stage_ms={},
        skipped_images=0,
        drill_reference=drill_reference,
        motion=observation.motion[anchor],
    )


def _compare_with_truth(
    snapshot: NavigationSnapshot, observation: Observation, tool: ToolModel, channel: Channel
) -> tuple[str, ToolErrors | None]:
    """Return the reason why nothing is displayed, or the errors of what is displayed."""
    deviation, vertebra = snapshot.deviations[tool.name], snapshot.vertebra
    seen = observation.sightings[tool.marker]
    if isinstance(deviation, Absent):
        return deviation.reason.value, None
    if isinstance(vertebra, Absent):
        return vertebra.reason.value, None
    if not isinstance(seen, Seen):
        return AbsentReason.MARKER_UNSEEN.value, None
    shown = tool_in_vertebra(
        UncertainPose(pose=vertebra.camera_from_vertebra, covariance=vertebra.covariance),
        UncertainPose(pose=seen.camera_from_marker, covariance=seen.pose_covariance),
        tool,
        tip_jacobian=vertebra.tip_jacobian_for(tool),
    )
    return "", tool_errors(shown, observation.vertebra_from_tool, channel)


def _is_through(
    observation: Observation, tool: ToolModel, drill_reference: DrillReference, channel: Channel
) -> bool:
    rings = drill_rings(
        observation.vertebra_from_tool,
        channel,
        drill_reference.wall,
        radius_mm=tool.radius_mm,
        length_mm=tool.length_mm,
    ).now
    return rings.counts > 0 and float(rings.clearance_mm.min()) < 0.0


def _spread_over(from_s: float, to_s: float, count: int, random: np.random.Generator) -> list[float]:
    """Return one random time in each of `count` equal intervals."""
    parts = (np.arange(count) + random.uniform(0.0, 0.9, count)) / count
    return [float(from_s + (to_s - from_s) * part) for part in parts]


def _bursts(last_s: Sequence[float], settings: VerificationSettings) -> list[float]:
    """Return the times of several consecutive images that end at each given time."""
    before = range(settings.burst_images - 1, -1, -1)
    return [time - number / settings.image_hz if number else time for time in last_s for number in before]
