"""Hand motion for landmark capture and surface sweeps: contact with the bone, and hops in between."""

from dataclasses import dataclass

import numpy as np

from tracker.geometry import Array, Rigid, Tool, Vertebra
from tracker.rehearsal.anatomy import bone_normals
from tracker.rehearsal.landmarks import Landmark, surface_exits
from tracker.rehearsal.motion import Phase, Pose6, catmull_rom

TABLE_HZ = 100
HOP_S = 2.2
STROKE_S, STROKE_HOP_S = 2.6, 1.2
# Hop height that clears the spinous process and the needles.
HOP_HEIGHT_MM = 80.0
STROKE_HEIGHT_MM, MIN_LIFT_MM = 26.0, 24.0
# Sd of the landing error on a landmark in each of two directions, and of the tremor on it.
LANDING_SD_MM = 0.15
SHAKE_HZ = np.array([1.3, 8.4, 9.3, 10.6])
SHAKE_MM = np.array([0.05, 0.06, 0.055, 0.04])
PRESSED_RATIO = 0.45  # tremor perpendicular to the surface, relative to that along it
SHAKE_DEG = 0.25
LEAN_RATIO, MAX_LEAN_DEG = 0.45, 16.0

# A stroke: its ends inside the bone, the directions to the surface there, and the amplitude of its zigzag
# along z.
Stroke = tuple[
    tuple[float, float, float],
    tuple[float, float, float],
    tuple[float, float, float],
    tuple[float, float, float],
    float,
]
STROKES: tuple[Stroke, ...] = (
    ((15.5, 11.0, -2.0), (5.0, 18.0, -7.0), (0.45, 0.89, 0.0), (0.45, 0.89, 0.0), 5.0),  # left lamina
    ((0.0, 27.0, -8.0), (0.0, 43.0, -10.0), (0.80, 0.60, 0.0), (0.75, 0.66, 0.0), 6.0),  # spinous, left
    ((0.0, 46.0, -5.0), (0.0, 46.0, -17.0), (0.0, 0.70, 0.71), (0.0, 0.55, -0.83), 0.0),  # its edge
    ((0.0, 43.0, -10.0), (0.0, 27.0, -8.0), (-0.75, 0.66, 0.0), (-0.80, 0.60, 0.0), 6.0),  # spinous, right
    ((-5.0, 18.0, -7.0), (-15.5, 11.0, -2.0), (-0.45, 0.89, 0.0), (-0.45, 0.89, 0.0), 5.0),  # right lamina
    ((19.5, 12.0, 8.0), (20.2, 13.5, 20.5), (0.3, 0.95, 0.0), (0.0, 0.55, 0.83), 0.0),  # left facet, upwards
    ((24.0, 11.0, 4.0), (40.0, 13.3, 5.8), (0.0, 0.60, 0.80), (0.2, 0.60, 0.77), 0.0),  # transverse, above
    ((40.0, 13.3, 5.8), (24.0, 11.0, 4.0), (0.2, 0.60, -0.77), (0.0, 0.60, -0.80), 0.0),  # and below
    ((14.0, 15.0, -12.0), (13.2, 17.0, -24.0), (0.2, 0.97, 0.0), (0.0, 0.55, -0.83), 0.0),  # left, downwards
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Dwell:
    """A period of contact with the bone.

    Attributes:
        points_mm: (n, 3), tip positions at `TABLE_HZ`, in the vertebra's frame.
        outwards: (n, 3), the surface's normals there.
        touched: the landmark's name; empty for a stroke.
        phase: phase of the motion.
    """

    points_mm: Array
    outwards: Array
    touched: str
    phase: Phase


class WaypointHand:
    """A hand that cycles through a list of dwells.

    Args:
        stays: the dwells in order.
        hop_s: time from one dwell to the next.
        height_mm: height of the tip in between.
        rest: the drill at rest, in whose frame it is held.
        seed: of tremor.
    """

    def __init__(
        self,
        stays: list[Dwell],
        *,
        hop_s: float,
        height_mm: float,
        rest: Rigid[Vertebra, Tool],
        seed: int,
    ) -> None:
        random = np.random.default_rng([seed, 0x4A4F5552])
        self._stays = stays
        rows, self._starts_s, self._ends_s = [], [], []
        count = 0
        for index, stay in enumerate(stays):
            before = stays[index - 1]
            rows.append(_hop(before, stay, hop_s, height_mm, rest))
            count += len(rows[-1])
            self._starts_s.append(count / TABLE_HZ)
            rows.append(_dwell(stay.points_mm, stay.outwards, rest))
            count += len(rows[-1])
            self._ends_s.append(count / TABLE_HZ)
        self._table = np.concatenate(rows)
        self.cycle_s = count / TABLE_HZ
        # Integer numbers of periods per cycle keep the motion periodic.
        self._rates = 2.0 * np.pi * np.round(SHAKE_HZ * self.cycle_s) / self.cycle_s
        self._offsets = random.uniform(0.0, 2.0 * np.pi, (6, len(SHAKE_HZ)))
        self._sizes = np.tile(SHAKE_MM, (3, 1)) * random.uniform(0.85, 1.15, (3, 1))
        self._rest = rest

    def at(self, at_s: float) -> Pose6:
        """Return the drill pose at this time."""
        time_s = at_s % self.cycle_s
        values = catmull_rom(self._table, time_s * TABLE_HZ)
        waves = np.sin(self._rates * time_s + self._offsets)
        shake_mm = (self._sizes * waves[:3]).sum(axis=1)
        stay, since_s = self._dwell_at(time_s)
        if stay is not None:
            row = min(int(since_s * TABLE_HZ), len(stay.outwards) - 1)
            normal = self._rest.rotation.T @ stay.outwards[row]
            shake_mm -= (1.0 - PRESSED_RATIO) * (shake_mm @ normal) * normal
        tip = values[:3] + shake_mm
        turn = values[3:] + SHAKE_DEG * waves[3:].mean(axis=1)
        return Pose6(across_mm=tip[:2], depth_mm=float(tip[2]), rotation_deg=turn)

    def phase_at(self, at_s: float) -> Phase:
        """Return the phase of the motion at this time."""
        stay, _ = self._dwell_at(at_s % self.cycle_s)
        return Phase.MOVE if stay is None else stay.phase

    def touched_at(self, at_s: float) -> str:
        """Return the name of the landmark under the tip; empty if there is none."""
        stay, _ = self._dwell_at(at_s % self.cycle_s)
        return "" if stay is None else stay.touched

    def _dwell_at(self, time_s: float) -> tuple[Dwell | None, float]:
        """Return the current dwell and the time since its start in seconds."""
        for stay, start_s, end_s in zip(self._stays, self._starts_s, self._ends_s, strict=True):
            if start_s <= time_s < end_s:
                return stay, time_s - start_s
        return None, 0.0


def landmark_hand(
    landmarks: tuple[Landmark, ...], *, rest_s: float, rest: Rigid[Vertebra, Tool], seed: int
) -> WaypointHand:
    """Return a hand that rests on each landmark, with a random landing error."""
    random = np.random.default_rng([seed, 0x544F5543])
    rows = round(rest_s * TABLE_HZ)
    stays = []
    for landmark in landmarks:
        beside = random.normal(0.0, LANDING_SD_MM, 3)
        beside -= (beside @ landmark.outwards) * landmark.outwards
        stays.append(
            Dwell(
                points_mm=np.tile(landmark.point_in_vertebra_mm + beside, (rows, 1)),
                outwards=np.tile(landmark.outwards, (rows, 1)),
                touched=landmark.name,
                phase=Phase.TOUCH,
            )
        )
    return WaypointHand(stays, hop_s=HOP_S, height_mm=HOP_HEIGHT_MM, rest=rest, seed=seed)


def sweep_hand(*, rest: Rigid[Vertebra, Tool], seed: int) -> WaypointHand:
    """Return a hand that sweeps lamina, spinous process and facets in strokes of bone contact."""
    random = np.random.default_rng([seed, 0x53574545])
    return WaypointHand(
        [_swept(stroke, random) for stroke in STROKES],
        hop_s=STROKE_HOP_S,
        height_mm=STROKE_HEIGHT_MM,
        rest=rest,
        seed=seed,
    )


def _swept(stroke: Stroke, random: np.random.Generator) -> Dwell:
    """Return a stroke as bone contacts, varied by the seed."""
    start, end, way, other_way, zigzag_mm = stroke
    share = _eased(np.linspace(0.0, 1.0, round(STROKE_S * TABLE_HZ)))[:, None]
    anchors = np.array(start) + share * (np.array(end) - np.array(start))
    anchors[:, 2] += zigzag_mm * np.sin(2.0 * np.pi * 2.0 * share[:, 0] + random.uniform(-0.5, 0.5))
    ways = np.array(way) + share * (np.array(other_way) - np.array(way)) + random.normal(0.0, 0.03, 3)
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    points = surface_exits(anchors, ways)
    return Dwell(points_mm=points, outwards=bone_normals(points), touched="", phase=Phase.SWEEP)


def _dwell(points_mm: Array, outwards: Array, rest: Rigid[Vertebra, Tool]) -> Array:
    """Return tips (n, 3) in mm and rotations (n, 3) in degrees in the rest frame, tilted to the surface."""
    tips = rest.inverse.move_points(points_mm)
    inwards = -outwards @ rest.rotation
    # From straight down (0, 0, 1) towards the surface's own direction.
    sideways = np.hypot(inwards[:, 0], inwards[:, 1])
    angle_deg = np.degrees(np.arctan2(sideways, inwards[:, 2]))
    lean_deg = np.clip(LEAN_RATIO * angle_deg, 0.0, MAX_LEAN_DEG)
    axis = np.stack([-inwards[:, 1], inwards[:, 0], np.zeros(len(inwards))], axis=1)
    axis /= np.maximum(sideways, 1e-9)[:, None]
    return np.hstack([tips, lean_deg[:, None] * axis])


def _hop(before: Dwell, after: Dwell, hop_s: float, height_mm: float, rest: Rigid[Vertebra, Tool]) -> Array:
    """Return the path between two dwells: along the normal off the bone, across, and down again."""
    rows = round(hop_s * TABLE_HZ)
    share = _eased((np.arange(rows) + 0.5) / rows)[:, None]
    ends = _dwell(
        np.stack([before.points_mm[-1], after.points_mm[0]]),
        np.stack([before.outwards[-1], after.outwards[0]]),
        rest,
    )
    a, b = ends[0, :3], ends[1, :3]
    from_mm, to_mm = before.points_mm[-1], after.points_mm[0]
    # The spinous process and the needles stand between left and right.
    height_mm = HOP_HEIGHT_MM if from_mm[0] * to_mm[0] < -20.0 else height_mm
    above = np.maximum(height_mm - np.array([from_mm[1], to_mm[1]]), MIN_LIFT_MM)
    back = rest.rotation.T @ np.array([0.0, 1.0, 0.0])
    over_a, over_b = a + above[0] * back, b + above[1] * back
    weights = [(1 - share) ** 3, 3 * (1 - share) ** 2 * share, 3 * (1 - share) * share**2, share**3]
    tips = weights[0] * a + weights[1] * over_a + weights[2] * over_b + weights[3] * b
    return np.hstack([tips, ends[0, 3:] + share * (ends[1, 3:] - ends[0, 3:])])


def _eased(share: Array) -> Array:
    """Return a smooth step from 0 to 1."""
    return np.asarray(share**3 * (10.0 - 15.0 * share + 6.0 * share**2))
