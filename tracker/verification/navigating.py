"""The operation with what was registered: image by image, what is shown, and how far it is off."""

from collections.abc import Sequence

import numpy as np

from tracker.navigation import Absent, Guide, NavigationSnapshot, Setup, navigate
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
NEVER_S = -1.0


def operation_looks(
    eyes: Eyes, settings: VerificationSettings, random: np.random.Generator
) -> tuple[list[Look], set[float]]:
    """The operation without any event, and the times that count."""
    counting = _spread_over(FROM_S, TO_S, settings.looks, random)
    return eyes.looks(eyes.scene(Scene.OPERATION), _bursts(counting, settings)), set(counting)


def moved_looks(
    eyes: Eyes, settings: VerificationSettings, random: np.random.Generator
) -> tuple[list[Look], set[float]]:
    """The operation, in the middle of which the camera is moved, and the times that count."""
    at_s = settings.moves_at_s
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
    return eyes.looks(eyes.scene(Scene.OPERATION, (move,)), times), set(counting)


def rows_of(
    looks: Sequence[Look],
    counting: set[float],
    registration: Registration,
    variant: Variant,
    *,
    eyes: Eyes,
    tool: ToolModel,
    guide: Guide,
    settings: VerificationSettings,
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
    for look in looks:
        since_s = look.at_s - settings.moves_at_s if variant.camera_moves else NEVER_S
        counts = look.at_s in counting
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
    if isinstance(deviation, Absent):
        return deviation.reason.value, None
    seen = look.sightings[tool.marker]
    if isinstance(vertebra, Absent) or not isinstance(seen, Seen):
        raise RuntimeError("a deviation is shown without marker or vertebra")
    shown = placed_tool(
        Placed(pose=vertebra.camera_from_vertebra, covariance=vertebra.covariance),
        Placed(pose=seen.camera_from_marker, covariance=seen.pose_covariance),
        tool,
    )
    return "", held(shown, look.vertebra_from_tool, channel)


def _is_through(look: Look, tool: ToolModel, guide: Guide, channel: Channel) -> bool:
    rings = drill_rings(
        look.vertebra_from_tool, channel, guide.wall, radius_mm=tool.radius_mm, length_mm=tool.length_mm
    ).now
    return rings.counts > 0 and float(rings.clearance_mm.min()) < 0.0


def _spread_over(from_s: float, to_s: float, count: int, random: np.random.Generator) -> list[float]:
    """One time in each of so many equal parts."""
    return (from_s + (to_s - from_s) * (np.arange(count) + random.uniform(0.0, 0.9, count)) / count).tolist()


def _bursts(last_s: Sequence[float], settings: VerificationSettings) -> list[float]:
    """Some images in a row, of which each time is the last one."""
    before = range(settings.burst_images - 1, -1, -1)
    return [time - number / settings.image_hz if number else time for time in last_s for number in before]
