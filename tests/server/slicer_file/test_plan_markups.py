"""A plan as lines and point lists, and a channel's direction from a line."""

import numpy as np
import pytest

from server.slicer_file import (
    Markup,
    MarkupKind,
    channel_markup,
    landmarks_from_markups,
    line_from_markups,
    plan_markups,
    screw_markup,
)
from tracker.errors import InvalidInput
from tracker.plan import Channel, Landmark, PlanDocument, PlannedChannel, VertebraPlan

# From back to front and to the middle, as in a left pedicle in LPS.
CHANNEL = Channel(
    name="L3 left",
    entry_in_vertebra_mm=np.array([15.0, 30.0, 5.0]),
    target_in_vertebra_mm=np.array([3.0, -10.0, 5.0]),
    radius_mm=3,
)
LANDMARKS = (
    Landmark(name="left facet", point_lps_mm=np.array([18.0, 2.0, 12.0])),
    Landmark(name="spinous process", point_lps_mm=np.array([0.0, 60.0, -4.0])),
)


def line(first: list[float], second: list[float], labels: tuple[str, str] = ("L-1", "L-2")) -> Markup:
    return Markup(kind=MarkupKind.LINE, name="", points_lps_mm=np.array([first, second]), labels=labels)


def test_a_plan_has_a_list_of_landmarks_and_a_line_for_each_channel() -> None:
    vertebra = VertebraPlan(
        name="L3", landmarks=LANDMARKS, channels=(PlannedChannel(side="left", channel=CHANNEL),)
    )
    points, channel = plan_markups(PlanDocument(vertebrae=(vertebra, VertebraPlan(name="L4"))))
    assert (points.kind, points.name) == (MarkupKind.POINTS, "L3 landmarks")
    assert landmarks_from_markups([points, channel], name="a file")[1].name == "spinous process"
    assert np.array_equal(points.points_lps_mm[1], LANDMARKS[1].point_lps_mm)
    assert (channel.kind, channel.name) == (MarkupKind.LINE, "L3 left channel")
    assert channel.labels == ("entry", "target")
    assert channel.description == "diameter 6.0 mm, length 41.8 mm"
    entry, target = line_from_markups([points, channel], name="a file")
    assert np.array_equal(entry, CHANNEL.entry_in_vertebra_mm)
    assert np.array_equal(target, CHANNEL.target_in_vertebra_mm)


def test_a_screw_begins_at_the_entry_and_is_as_long_as_planned() -> None:
    screw = screw_markup(CHANNEL, diameter_mm=6.5, length_mm=45.0)
    entry, tip = screw.points_lps_mm
    assert screw.name == "L3 left screw 6.5 x 45 mm"
    assert np.array_equal(entry, CHANNEL.entry_in_vertebra_mm)
    assert np.linalg.norm(tip - entry) == pytest.approx(45.0)
    assert np.cross(tip - entry, CHANNEL.axis_in_vertebra) == pytest.approx(np.zeros(3), abs=1e-12)
    assert tip[1] < entry[1]


@pytest.mark.parametrize(
    ("markup", "entry_y_mm"),
    [
        pytest.param(line([15, 30, 5], [3, -10, 5]), 30, id="forwards"),
        pytest.param(line([3, -10, 5], [15, 30, 5], ("target", "entry")), 30, id="named-the-other-way"),
        pytest.param(line([3, -10, 5], [15, 30, 5], (" Entry", "TARGET ")), -10, id="named-backwards"),
    ],
)
def test_the_entry_is_the_first_point_or_the_one_that_is_named_so(markup: Markup, entry_y_mm: float) -> None:
    entry, _ = line_from_markups([markup], name="a file")
    assert entry[1] == entry_y_mm


@pytest.mark.parametrize(
    "markup",
    [
        pytest.param(line([3, -10, 5], [15, 30, 5]), id="backwards"),
        pytest.param(line([15, 3, 5], [-15, 0, 5]), id="across"),
        pytest.param(line([3, -10, 5], [15, 30, 5], ("entry", "entry")), id="two-entries"),
    ],
)
def test_a_line_whose_direction_is_not_known_is_rejected(markup: Markup) -> None:
    with pytest.raises(InvalidInput) as rejected:
        line_from_markups([markup], name="a file")
    assert rejected.value.code == "CHANNEL_DIRECTION_UNKNOWN"


def test_one_line_and_one_list_are_needed() -> None:
    two = [channel_markup(CHANNEL), screw_markup(CHANNEL, diameter_mm=6, length_mm=40)]
    with pytest.raises(InvalidInput, match="2 markups of the kind line, expected 1"):
        line_from_markups(two, name="a file")
    with pytest.raises(InvalidInput, match="0 markups of the kind point list, expected 1"):
        landmarks_from_markups(two, name="a file")


def test_landmarks_need_their_names() -> None:
    unnamed = Markup(
        kind=MarkupKind.POINTS, name="", points_lps_mm=np.zeros((3, 3)), labels=("facet", " ", "")
    )
    with pytest.raises(InvalidInput, match="2 points without a label, the first is point 2"):
        landmarks_from_markups([unnamed], name="a file")
