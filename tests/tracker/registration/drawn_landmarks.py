"""Simulated landmarks, and the share of truths inside what their registrations state."""

from dataclasses import dataclass, field

import numpy as np
from scipy.special import chdtri

from tests.tracker.registration.constellations import random_landmarks, touched
from tracker.geometry import Anchor, Rigid, Vertebra, vector_from_rotation
from tracker.registration import AnchoredTo
from tracker.registration.points import PointPairs, PointRegistration, PointSettings, register_points

# Along the camera's depth noise is four times as large as across it.
LIKE_A_NEEDLE = np.diag([0.3, 0.3, 1.2]) ** 2
# No floor, order check or gross errors: the noise itself is tested.
BARE = PointSettings(min_fle_mm=1e-3, max_accepted_fre_mm=20.0, max_left_out_mm=np.inf)


@dataclass
class Simulated:
    """Share of truths inside 95 %, and errors of the targets."""

    along: list[bool] = field(default_factory=list)
    target: list[bool] = field(default_factory=list)
    squared: list[float] = field(default_factory=list)
    pose: list[bool] = field(default_factory=list)
    off_mm2: list[float] = field(default_factory=list)
    expected_mm2: list[float] = field(default_factory=list)

    def look(
        self, found: PointRegistration, truth: Rigid[Vertebra, Anchor], rng: np.random.Generator
    ) -> None:
        target = found.pairs.fixed_mm.mean(axis=0) + rng.uniform(-30.0, 30.0, 3)
        off = found.fixed_from_moving.move_points(truth.inverse.move_points(target)) - target
        covariance = found.target_covariance_mm2(target)
        way = np.linalg.qr(rng.normal(size=(3, 3)))[0][0]
        self.along.append(bool(abs(off @ way) < 1.96 * np.sqrt(way @ covariance @ way)))
        self.squared.append(float(off @ np.linalg.solve(covariance, off)))
        self.target.append(self.squared[-1] < chdtri(3, 0.05))
        given = found.registration(AnchoredTo.CAMERA)
        turn = truth.rotation.T @ given.anchor_from_vertebra.rotation.T
        pose = np.concatenate(
            [
                truth.inverse.translation_mm - given.anchor_from_vertebra.translation_mm,
                vector_from_rotation(turn),
            ]
        )
        self.pose.append(bool(pose @ np.linalg.solve(given.covariance, pose) < chdtri(6, 0.05)))
        self.off_mm2.append(float(off @ off))
        self.expected_mm2.append(found.tre_expected_mm(target) ** 2)


def simulated(count: int, noise: np.ndarray | float, stated: np.ndarray | None, *, runs: int) -> Simulated:
    """Registrations of random landmarks, each touched with this noise."""
    rng = np.random.default_rng(count)
    seen = Simulated()
    for _ in range(runs):
        truth = touched(random_landmarks(rng, count), rng, noise)
        pairs = PointPairs(
            fixed_mm=truth.fixed_mm,
            moving_mm=truth.moving_mm,
            moving_covariances_mm2=None if stated is None else np.broadcast_to(stated, (count, 3, 3)),
        )
        seen.look(register_points(pairs, settings=BARE), truth.fixed_from_moving, rng)
    return seen


# Each kind of noise and each count, not their product: the factor for few landmarks depends on the count, and
# whether residuals or the statement give the noise depends on the kind. Count, noise, statement:
KINDS: dict[str, tuple[int, np.ndarray | float, np.ndarray | None]] = {
    "like a ball and unknown, 3": (3, 0.6, None),
    "like a ball and unknown, 6": (6, 0.6, None),
    "like a needle and unknown, 4": (4, LIKE_A_NEEDLE, None),
    "like a needle and stated, 3": (3, LIKE_A_NEEDLE, LIKE_A_NEEDLE),
    "like a needle and stated, 4": (4, LIKE_A_NEEDLE, LIKE_A_NEEDLE),
}
