"""The operation with what was registered: image by image, what is shown, and how far it is off."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tracker.navigation import Absent, AbsentReason, Guide, NavigationSnapshot, Setup, navigate
from tracker.navigation.certainty import Placed
from tracker.navigation.clearance import drill_rings
from tracker.navigation.guide import placed_tool
from tracker.plan import Channel
from tracker.pose import Seen, ToolModel
from tracker.registration import AnchoredTo, Registration
from tracker.rehearsal import Event, EventKind, Scene
from tracker.verification.eyes import Eyes, Look
from tracker.verification.held import HeldTool, held
from tracker.verification.rows import ImageRow, Variant
from tracker.verification.settings import VerificationSettings

# The drill is in the picture, and near the bone.
FROM_S, TO_S = 1.5, 30.0
BEFORE_MOVE_S = 0.5
MOVE_MM, MOVE_DEG = (3.0, 20.0), (0.5, 3.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Operation:
    """Images of one operation.

    Attributes:
        looks: at all of them.
        counting_s: times of those that are spread over it.
        moves_at_s: when the camera is moved; infinite for never.
    """

    looks: tuple[Look, ...]
    counting_s: frozenset[float]
    moves_at_s: float


def operation_looks(eyes: Eyes, settings: VerificationSettings, random: np.random.Generator) -> "Operation":
    """The operation without any event."""
    counting = _spread_over(FROM_S, TO_S, settings.looks, random)
    looks = eyes.looks(eyes.scene(Scene.OPERATION), _bursts(counting, settings))
    return Operation(looks=tuple(looks), counting_s=frozenset(counting), moves_at_s=np.inf)


def moved_looks(eyes: Eyes, settings: VerificationSettings, random: np.random.Generator) -> "Operation":
    """The operation, in the middle of which the camera is moved."""
    # The scene is looked at now and then: a move must come at any time between.
    at_s = settings.moves_at_s + random.uniform(0.0, 1.0)
    move = Event(
        kind=EventKind.CAMERA_MOVES,
        at_s=at_s,
        size_mm=random.uniform(*MOVE_MM),
        size_deg=random.uniform(*MOVE_DEG),
    )
    before = _bursts([FROM_S + 4.0, FROM_S + 9.0], settings)
    around = np.arange(at_s - BEFORE_MOVE_S, at_s + settings.watched_s, 1.0 / settings.image_hz).tolist()
    counting = _spread_over(at_s + settings.watched_s + 0.5, TO_S, settings.looks // 2, random)
    times = [*before, *around, *_bursts(counting, settings)]
    looks = eyes.looks(eyes.scene(Scene.OPERATION, (move,)), times)
    return Operation(looks=tuple(looks), counting_s=frozenset(counting), moves_at_s=at_s)


def rows_of(
    operation: Operation,
    registration: Registration,
    variant: Variant,
    *,
    eyes: Eyes,
    tool: ToolModel,
    guide: Guide,
    seed: int,
) -> list[ImageRow]:
    """A row for each image that counts, and for each after the camera was moved."""
    channel = eyes.theatre.channels[0]
    setup = Setup(
        camera=eyes.theatre.camera,
        camera_calibrated=True,
        tools={tool.name: tool},
        channel=channel,
        registration=registration,
        reference="reference" if variant.anchored_to is AnchoredTo.REFERENCE else "",
    )
    rows = []
    for look in operation.looks:
        since_s = look.at_s - operation.moves_at_s
        counts = look.at_s in operation.counting_s
        if not counts and since_s < 0.0:
            continue
        snapshot = _snapshot(setup, look, variant.anchored_to, guide if counts else None)
        absent, off = _against(snapshot, look, tool, channel)
        judged = snapshot.judgements[tool.name]
        rows.append(
            ImageRow(
                seed=seed,
                variant=variant,
                at_s=look.at_s,
                phase=look.phase,
                counts=counts,
                since_move_s=since_s,
                absent=absent,
                held=off,
                is_through=counts and _is_through(look, tool, guide, channel),
                through_ratio=np.nan if isinstance(judged, Absent) else judged.now.through_ratio,
            )
        )
    return rows


def _snapshot(setup: Setup, look: Look, anchor: AnchoredTo, guide: Guide | None) -> NavigationSnapshot:
    return navigate(
        setup=setup,
        sightings=look.sightings_for(anchor),
        image_number=0,
        captured_at_s=look.at_s,
        size_wh_px=setup.camera.size_wh_px,
        stage_ms={},
        skipped_images=0,
        guide=guide,
        watched=look.watched[anchor],
    )


def _against(
    snapshot: NavigationSnapshot, look: Look, tool: ToolModel, channel: Channel
) -> tuple[str, HeldTool | None]:
    """Why nothing is shown, or what is shown against the truth."""
    deviation, vertebra = snapshot.deviations[tool.name], snapshot.vertebra
    seen = look.sightings[tool.marker]
    if isinstance(deviation, Absent):
        return deviation.reason.value, None
    if isinstance(vertebra, Absent):
        return vertebra.reason.value, None
    if not isinstance(seen, Seen):
        return AbsentReason.MARKER_UNSEEN.value, None
    shown = placed_tool(
        Placed(pose=vertebra.camera_from_vertebra, covariance=vertebra.covariance),
        Placed(pose=seen.camera_from_marker, covariance=seen.pose_covariance),
        tool,
        tip_slope=vertebra.tip_slope_for(tool),
    )
    return "", held(shown, look.vertebra_from_tool, channel)


def _is_through(look: Look, tool: ToolModel, guide: Guide, channel: Channel) -> bool:
    rings = drill_rings(
        look.vertebra_from_tool, channel, guide.wall, radius_mm=tool.radius_mm, length_mm=tool.length_mm
    ).now
    return rings.counts > 0 and float(rings.clearance_mm.min()) < 0.0


def _spread_over(from_s: float, to_s: float, count: int, random: np.random.Generator) -> list[float]:
    """One time in each of so many equal parts."""
    parts = (np.arange(count) + random.uniform(0.0, 0.9, count)) / count
    return [float(from_s + (to_s - from_s) * part) for part in parts]


def _bursts(last_s: Sequence[float], settings: VerificationSettings) -> list[float]:
    """Some images in a row, of which each time is the last one."""
    before = range(settings.burst_images - 1, -1, -1)
    return [time - number / settings.image_hz if number else time for time in last_s for number in before]
