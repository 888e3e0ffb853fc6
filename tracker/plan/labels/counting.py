"""Counting of levels: the names of labels against their positions along the spine.

A label that is named after the wrong level leads to a screw in the wrong vertebra. Names are therefore
counted a second time, by position: the order of the centroids along the spine, and the distance between
neighbouring ones, which must be plausible for the number of levels between their names.
"""

import itertools
from collections import Counter
from collections.abc import Sequence

import numpy as np

from tracker.errors import PlanError
from tracker.plan.channel import Channel
from tracker.plan.labels.label_volume import LabelVolume, VertebraLabel
from tracker.plan.labels.levels import LEVELS, level_from_name

# Plausible distances between the centroids of two adjacent vertebrae, by the region of the upper one, in mm:
# the height of an adult body with its disc, with a margin for small people and for processes that shift a
# centroid. In neck and chest the ranges of one and of two levels overlap, so that a single pair cannot prove
# a missing level there.
STEP_MM = {"C": (10.0, 26.0), "T": (14.0, 40.0), "L": (24.0, 48.0)}
CHECK_NAMES = "Compare the names of the labels with the CT, and segment or name them again."
CHECK_LEVEL = (
    "Count the vertebrae on the CT. Rename the vertebra or correct its channel, or replace the labels if "
    "they are wrong."
)
# A channel of another level: below this share a label only touches it.
MIN_SHARE = 0.1
CHANNEL_STEP_MM = 0.5


def check_levels(vertebrae: Sequence[VertebraLabel]) -> None:
    """Reject labels whose names contradict their positions.

    Args:
        vertebrae: from the head down by name.

    Raises:
        PlanError: LEVEL_DOUBTFUL.
    """
    if len(vertebrae) < 2:
        return
    _check_order(vertebrae)
    for upper, lower in itertools.pairwise(vertebrae):
        _check_distance(upper, lower)


def _check_order(vertebrae: Sequence[VertebraLabel]) -> None:
    centroids = np.array([one.centroid_lps_mm for one in vertebrae])
    # Direction of the largest spread of the centroids, towards the feet.
    axis = np.linalg.svd(centroids - centroids.mean(axis=0))[2][0]
    heights = centroids @ axis * (-1.0 if axis[2] > 0.0 else 1.0)
    order = np.argsort(heights, kind="stable")
    if (order == np.arange(len(order))).all():
        return
    named = ", ".join(one.level for one in vertebrae)
    placed = ", ".join(vertebrae[place].level for place in order)
    raise PlanError(
        "LEVEL_DOUBTFUL",
        f"the labels are out of order: from the head down they are {named} by name, but {placed} by position",
        CHECK_NAMES,
        {"named": named, "placed": placed},
    )


def _check_distance(upper: VertebraLabel, lower: VertebraLabel) -> None:
    first, last = LEVELS.index(upper.level), LEVELS.index(lower.level)
    limits = np.array([STEP_MM[LEVELS[place][0]] for place in range(first, last)])
    min_mm, max_mm = limits.sum(axis=0)
    distance_mm = float(np.linalg.norm(upper.centroid_lps_mm - lower.centroid_lps_mm))
    if min_mm <= distance_mm <= max_mm:
        return
    named = last - first
    placed = max(1, round(distance_mm / float(limits.mean())))
    raise PlanError(
        "LEVEL_DOUBTFUL",
        f"{upper.level} and {lower.level} are {named} levels apart by name, but their labels lie "
        f"{distance_mm:.0f} mm apart, about {placed} levels; allowed are {min_mm:.0f} to {max_mm:.0f} mm",
        CHECK_NAMES,
        {
            "upper": upper.level,
            "lower": lower.level,
            "named": named,
            "placed": placed,
            "distance_mm": distance_mm,
            "min_mm": float(min_mm),
            "max_mm": float(max_mm),
        },
    )


def check_channel(labels: LabelVolume, vertebra: str, channel: Channel) -> str:
    """Return the level in whose label a channel lies; empty if it lies in none, or its name is no level.

    Raises:
        PlanError: LEVEL_DOUBTFUL, most of the labelled part of the channel lies in another level than that
            which the vertebra of the plan is named after.
    """
    level = level_from_name(vertebra)
    if level is None:
        return ""
    count = max(2, round(channel.length_mm / CHANNEL_STEP_MM))
    ratios = np.linspace(0.0, 1.0, count)[:, None]
    points = channel.entry_in_vertebra_mm + ratios * (
        channel.target_in_vertebra_mm - channel.entry_in_vertebra_mm
    )
    found = Counter(one for one in labels.level_at(points) if one)
    if not found:
        return ""
    prevailing, hits = found.most_common(1)[0]
    if prevailing == level or hits < MIN_SHARE * count:
        return level if found[level] else ""
    share, own = 100.0 * hits / count, 100.0 * found[level] / count
    steps = abs(LEVELS.index(prevailing) - LEVELS.index(level))
    raise PlanError(
        "LEVEL_DOUBTFUL",
        f"the channel {channel.name} is planned for {level}, but {share:.0f} % of its length lies in the "
        f"label {prevailing}, {steps} levels away, and {own:.0f} % in {level}",
        CHECK_LEVEL,
        {
            "channel": channel.name,
            "planned": level,
            "prevailing": prevailing,
            "steps": steps,
            "share": share,
            "own": own,
        },
    )
