"""Other starts, and what they lead to: a sweep that fits in a second place says so.

A fit is started from fifteen poses: the bumps of a mesh hold a sweep in place that in truth slides on the
bone, so a second place that fits is found only by starting there. Normals are smoothed over 3 mm for the
same reason. It costs half a second, and directions that only fine relief would hold count as open.
"""

from collections.abc import Sequence

import numpy as np

from tracker.geometry import Anchor, Array, Rigid, Vertebra, rotation_from_vector
from tracker.registration.surface.fit import Laid, Sweep, cost, laid_on
from tracker.registration.surface.nearest import NearestOnSurface
from tracker.registration.surface.rejections import reject_rival
from tracker.registration.surface.settings import SurfaceSettings
from tracker.registration.surface.sliding import in_words

# A second place is as good unless it is worse by this chi-square, and by this share of the best.
NEWS, NEWS_SHARE = 12.0, 0.3
# Enough to tell places apart.
NEARLY_STILL_MM = 0.02


def best_of(
    nearest: NearestOnSurface,
    sweep: Sweep,
    start: Rigid[Vertebra, Anchor],
    first: Laid,
    weak_way: Array,
    lever_mm: float,
    settings: SurfaceSettings,
) -> tuple[Laid, list[Laid]]:
    """The best fit from the start and from those around it, and all the others."""
    middle = start.move_points(sweep.points_mm).mean(axis=0)
    ways = np.zeros((7, 6))
    ways[:3, :3] = settings.tried_shift_mm * np.eye(3)
    ways[3:6, 3:] = np.radians(settings.tried_turn_deg) * np.eye(3)
    # Along what is known least, as far as any other.
    ways[6] = settings.tried_shift_mm * weak_way / np.concatenate([np.ones(3), np.full(3, lever_mm)])
    fits = [first]
    for way in (*ways, *-ways):
        turn = rotation_from_vector(way[3:])
        base = first.fixed_from_moving if np.array_equal(np.abs(way), np.abs(ways[6])) else start
        moved: Rigid[Vertebra, Anchor] = Rigid(
            rotation=turn @ base.rotation,
            translation_mm=turn @ (base.translation_mm - middle) + middle + way[:3],
        )
        fits.append(laid_on(nearest, sweep, moved, still_mm=NEARLY_STILL_MM))
    sd = min(fit.sd_mm for fit in fits)
    order = sorted(range(len(fits)), key=lambda one: cost(sweep, fits[one], sd))
    best = laid_on(nearest, sweep, fits[order[0]].fixed_from_moving)
    return best, [fits[one] for one in order[1:]]


def reject_another_place(
    sweep: Sweep, best: Laid, rivals: Sequence[Laid], targets_mm: Array, settings: SurfaceSettings
) -> None:
    """Raise where the sweep fits somewhere else about as well.

    Raises:
        RegistrationError: SURFACE_AMBIGUOUS.
    """
    least = cost(sweep, best, best.sd_mm)
    moving = best.fixed_from_moving.inverse.move_points(targets_mm)
    for rival in rivals:
        shifts = rival.fixed_from_moving.move_points(moving) - targets_mm
        apart = np.linalg.norm(shifts, axis=1)
        if apart.max() <= settings.max_apart_mm:
            continue
        if cost(sweep, rival, best.sd_mm) - least < max(NEWS, NEWS_SHARE * least):
            way = np.concatenate([shifts[int(np.argmax(apart))], np.zeros(3)])
            reject_rival(float(apart.max()), in_words(way), (_rms(sweep, best), _rms(sweep, rival)))


def _rms(sweep: Sweep, laid: Laid) -> float:
    say = sweep.shares * (laid.weights > 0.0)
    return float(np.sqrt((say * laid.off_mm**2).sum() / say.sum()))
