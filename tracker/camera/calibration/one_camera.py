"""Detect views of two different cameras.

Views of two cameras of the same model, or of one whose zoom was changed, can be fitted together to 0.22 px,
and the result describes neither of them. A bent board separates views in the same way, so this is a warning
and not an error.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from tracker.camera.calibration.blocks import Block, total_information
from tracker.camera.calibration.fit import Fit
from tracker.camera.calibration.report import rms
from tracker.errors import Remark
from tracker.geometry import Array

# Focal lengths and principal point differ between the groups; the distortion is common, to avoid overfitting.
OWN = 4
MIN_VIEWS, MIN_MEMBERS = 8, 2
# Maximum ratio of the squared residuals with two cameras to those with one. Real single cameras have 0.88 and
# more, pairs of the same model 0.80 and less.
CLEAR_RATIO = 0.85
# Alternatively: minimum ratio of the decrease of chi-square by the first split to that of any further one.
# Single cameras have up to 5, pairs under white noise 10 to 300.
CLEAR_FACTOR, MIN_CHI2 = 8.0, 60.0
STARTS, ROUNDS = 24, 30
# Maximum number of views named in the message.
NAMED = 4

Members = npt.NDArray[np.bool_]


@dataclass(frozen=True, slots=True, kw_only=True)
class TwoGroups:
    """Views that fall into two groups.

    Attributes:
        smaller: indexes of the views of the smaller group.
        difference_px: (4,), its fx, fy, cx and cy minus those of the others.
        left_ratio: RMS with two cameras as a ratio of that with one.
    """

    smaller: tuple[int, ...]
    difference_px: Array
    left_ratio: float


@dataclass(frozen=True, slots=True, kw_only=True)
class _Split:
    """One split of the views: members of the second group, decrease of chi-square, both cameras' steps."""

    second: Members
    gain_px2: float
    first_step: Array
    second_step: Array


def two_groups(blocks: Sequence[Block]) -> TwoGroups | None:
    """Return the two groups into which the views of a fitted camera fall; None for a single camera.

    To first order about the common camera, the gradient of each view (`Block`) determines its group. A bent
    board separates views in the same way, so this is only used for a warning.
    """
    if len(blocks) < MIN_VIEWS:
        return None
    split = _best_split(blocks)
    if split is None:
        return None
    squares_px2 = sum(block.squares_px2 for block in blocks)
    left_px2 = squares_px2 - split.gain_px2
    noise_px2 = left_px2 / sum(block.coordinates - block.own for block in blocks)
    further_px2 = _further_gain_px2(blocks, split)
    by_rms = left_px2 <= CLEAR_RATIO * squares_px2
    by_factor = split.gain_px2 >= max(CLEAR_FACTOR * further_px2, MIN_CHI2 * noise_px2)
    if not (by_rms or by_factor):
        return None
    difference = (split.second_step - split.first_step)[:OWN]
    is_second_smaller = 2 * int(split.second.sum()) <= len(blocks)
    members = split.second if is_second_smaller else ~split.second
    return TwoGroups(
        smaller=tuple(int(i) for i in np.flatnonzero(members)),
        difference_px=difference if is_second_smaller else -difference,
        left_ratio=float(np.sqrt(max(left_px2, 0.0) / squares_px2)),
    )


def two_camera_warnings(fit: Fit, blocks: Sequence[Block], names: Sequence[str]) -> tuple[Remark, ...]:
    """Return a warning if two cameras fit the views (of these names) clearly better than one."""
    groups = two_groups(blocks)
    if groups is None:
        return ()
    apart = [names[at] for at in groups.smaller]
    shown = ", ".join(apart[:NAMED]) + (f" and {len(apart) - NAMED} more" if apart[NAMED:] else "")
    rms_px = rms(np.concatenate(fit.residuals_px))
    by = groups.difference_px
    return (
        Remark(
            code="TWO_CAMERAS",
            message=f"{len(apart)} of {len(blocks)} views ({shown}) fit a separate camera clearly better: "
            f"RMS {rms_px * groups.left_ratio:.3f} px instead of {rms_px:.3f} px, with focal "
            f"lengths that differ by {by[0]:+.1f} and {by[1]:+.1f} px and a middle by {by[2]:+.1f} and "
            f"{by[3]:+.1f} px",
            remedy="Give images of one camera at one zoom and focus, and of a board that is flat and stiff.",
            context={
                "apart": len(apart),
                "views": len(blocks),
                "view_names": shown,
                "named_views": ", ".join(apart[:NAMED]),
                "further_views": len(apart[NAMED:]),
                "split_rms_px": rms_px * groups.left_ratio,
                "rms_px": rms_px,
                "difference_px": [float(one) for one in by[:4]],
            },
        ),
    )


def _best_split(blocks: Sequence[Block]) -> _Split | None:
    """Return the best split from several starts, by reassigning views until convergence (as in k-means)."""
    count = len(blocks)
    rng = np.random.default_rng(0)
    order = np.arange(count)
    # Files of two cameras are mostly consecutive.
    starts = [order >= cut for cut in {count // 4, count // 2, 3 * count // 4}]
    starts += [rng.integers(0, 2, count).astype(bool) for _ in range(STARTS)]
    informations = np.array([block.information for block in blocks])
    gradients = np.array([block.gradient for block in blocks])
    scale = 1.0 / np.sqrt(np.maximum(np.diag(total_information(blocks)), 1e-300))
    settled = (
        _converged(start, informations * scale * scale[:, None], gradients * scale) for start in starts
    )
    found = [split for split in settled if split is not None]
    if not found:
        return None
    best = max(found, key=lambda split: split.gain_px2)
    return replace(best, first_step=best.first_step * scale, second_step=best.second_step * scale)


def _converged(second: Members, informations: Array, gradients: Array) -> _Split | None:
    split: _Split | None = None
    for _ in range(ROUNDS):
        if min(int(second.sum()), int((~second).sum())) < MIN_MEMBERS:
            return split
        split = _fitted(second, informations, gradients)
        moved = _costs(split.second_step, informations, gradients) < _costs(
            split.first_step, informations, gradients
        )
        if (moved == second).all():
            return split
        second = moved
    return split


def _fitted(second: Members, informations: Array, gradients: Array) -> _Split:
    """Return the steps of both groups' cameras from the common one, with a common distortion."""
    whole, part = informations.sum(axis=0), informations[second].sum(axis=0)
    size = len(whole)
    normal = np.block([[whole, part[:, :OWN]], [part[:OWN], part[:OWN, :OWN]]])
    pull = np.concatenate([gradients.sum(axis=0), gradients[second].sum(axis=0)[:OWN]])
    step = np.linalg.pinv(normal, rcond=1e-12, hermitian=True) @ pull
    other = step[:size].copy()
    other[:OWN] += step[size:]
    return _Split(second=second, gain_px2=float(pull @ step), first_step=step[:size], second_step=other)


def _costs(step: Array, informations: Array, gradients: Array) -> Array:
    """Return the change of each view's squared residuals under a step of the camera."""
    return np.asarray(np.einsum("i,nij,j->n", step, informations, step) - 2.0 * gradients @ step)


def _further_gain_px2(blocks: Sequence[Block], split: _Split) -> float:
    """Return the largest gain of one more split of either group, as from noise and a bent board."""
    max_gain_px2 = 0.0
    for members, step in ((split.second, split.second_step), (~split.second, split.first_step)):
        group = [
            replace(block, gradient=block.gradient - block.information @ step)
            for block, is_member in zip(blocks, members, strict=True)
            if is_member
        ]
        further = _best_split(group) if len(group) >= 2 * MIN_MEMBERS else None
        max_gain_px2 = max(max_gain_px2, 0.0 if further is None else further.gain_px2)
    return max_gain_px2
