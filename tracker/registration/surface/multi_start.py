"""Multi-start ICP: detect a second minimum with a similar cost.

There are fifteen starts, because the triangles of a mesh create local minima for a sweep that is free to
slide on the bone, and a second minimum is found only from a start near it. Normals are smoothed over 3 mm for
the same reason. It takes half a second, and motion modes that only fine relief would constrain count as
unobservable.
"""

from collections.abc import Sequence

import numpy as np

from tracker.geometry import Anchor, Array, Rigid, Vertebra, rotation_from_vector
from tracker.registration.surface.closest_points import ClosestPointQuery
from tracker.registration.surface.fit import Sweep, SweepFit, cost, fit_sweep
from tracker.registration.surface.observability import description
from tracker.registration.surface.rejections import raise_ambiguous
from tracker.registration.surface.settings import SurfaceSettings

# A second minimum is excluded by this delta chi-square and by this ratio to the best.
MIN_DELTA_CHI2, MIN_DELTA_CHI2_RATIO = 12.0, 0.3
# Enough to distinguish minima.
COARSE_TOLERANCE_MM = 0.02


def multi_start_fit(
    nearest: ClosestPointQuery,
    sweep: Sweep,
    start: Rigid[Vertebra, Anchor],
    first: SweepFit,
    weak_direction: Array,
    lever_mm: float,
    settings: SurfaceSettings,
) -> tuple[SweepFit, list[SweepFit]]:
    """Return the best fit from all starts, and the others."""
    middle = start.move_points(sweep.points_mm).mean(axis=0)
    offsets = np.zeros((7, 6))
    offsets[:3, :3] = settings.start_shift_mm * np.eye(3)
    offsets[3:6, 3:] = np.radians(settings.start_rotation_deg) * np.eye(3)
    # Along the least observable mode, by the same distance.
    offsets[6] = settings.start_shift_mm * weak_direction / np.concatenate([np.ones(3), np.full(3, lever_mm)])
    fits = [first]
    for offset in (*offsets, *-offsets):
        turn = rotation_from_vector(offset[3:])
        base = first.fixed_from_moving if np.array_equal(np.abs(offset), np.abs(offsets[6])) else start
        moved: Rigid[Vertebra, Anchor] = Rigid(
            rotation=turn @ base.rotation,
            translation_mm=turn @ (base.translation_mm - middle) + middle + offset[:3],
        )
        fits.append(fit_sweep(nearest, sweep, moved, tolerance_mm=COARSE_TOLERANCE_MM))
    sd = min(fit.sd_mm for fit in fits)
    order = sorted(range(len(fits)), key=lambda one: cost(sweep, fits[one], sd))
    best = fit_sweep(nearest, sweep, fits[order[0]].fixed_from_moving)
    return best, [fits[one] for one in order[1:]]


def reject_ambiguous(
    sweep: Sweep,
    best: SweepFit,
    alternatives: Sequence[SweepFit],
    targets_mm: Array,
    settings: SurfaceSettings,
) -> None:
    """Reject a sweep with a second minimum of similar cost.

    Raises:
        RegistrationError: SURFACE_AMBIGUOUS.
    """
    minimum = cost(sweep, best, best.sd_mm)
    moving = best.fixed_from_moving.inverse.move_points(targets_mm)
    for alternative in alternatives:
        shifts = alternative.fixed_from_moving.move_points(moving) - targets_mm
        distances_mm = np.linalg.norm(shifts, axis=1)
        if distances_mm.max() <= settings.max_apart_mm:
            continue
        if cost(sweep, alternative, best.sd_mm) - minimum < max(
            MIN_DELTA_CHI2, MIN_DELTA_CHI2_RATIO * minimum
        ):
            offset = np.concatenate([shifts[int(np.argmax(distances_mm))], np.zeros(3)])
            raise_ambiguous(
                float(distances_mm.max()), description(offset), (_rms(sweep, best), _rms(sweep, alternative))
            )


def _rms(sweep: Sweep, laid: SweepFit) -> float:
    weight = sweep.point_weights * (laid.weights > 0.0)
    return float(np.sqrt((weight * laid.off_mm**2).sum() / weight.sum()))
