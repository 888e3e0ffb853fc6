"""Planning by touch on the rehearsal's CT: pedicles, channels, screws, lines and landmarks."""

import re
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import expect

from tests.browser.by_touch.tablet import Tablet
from tests.browser.small_targets import GLOVE_PX

PX_PER_MM = """() => {
    const ruler = document.querySelector(".planes-large .slice-ruler");
    return ruler.querySelector("span").getBoundingClientRect().width / parseFloat(ruler.textContent);
}"""


def plan_both_pedicles(tablet: Tablet, truth: dict[str, Any]) -> None:
    """Plan a channel and a screw in each pedicle, and choose one channel for drilling."""
    tablet.tap("rehearsal-ct")
    tablet.sees("slice-axial")
    tablet.tap("add-vertebra")
    tablet.tap("level-L3")
    for side, channel in zip(("left", "right"), truth["channels"], strict=True):
        _measured_where_it_is(tablet, side, channel)
    tablet.looked_at("plan")
    tablet.tap("activate")
    tablet.sees("is-active")
    assert _plan(tablet)["active_channel"]["side"] == "right"


def moved_and_undone(tablet: Tablet) -> None:
    """Move and save a channel by mistake, undo, redo and undo it again by keyboard, and choose it again."""

    def entry() -> Any:  # noqa: ANN401  JSON
        (vertebra,) = _plan(tablet)["plan"]["vertebrae"]
        right = next(one for one in vertebra["channels"] if one["side"] == "right")
        return right["channel"]["entry_in_vertebra_mm"]

    before = entry()
    tablet.tap("move-channel")
    knob = tablet.page.get_by_test_id("handle-entry").locator(".draw-handle-touch").bounding_box()
    assert knob is not None
    assert min(knob["width"], knob["height"]) >= GLOVE_PX
    tablet.tap("channel-right")
    tablet.tap("channel-right")
    tablet.tap("keep-channel")
    tablet.sees("move-channel")
    assert np.array(entry()) - before == pytest.approx([1.0, 0.0, 0.0], abs=1e-6)
    assert _plan(tablet)["active_channel"] is None
    moved = entry()
    for act, expected in (
        (lambda: tablet.tap("undo"), before),
        (lambda: tablet.tap("redo"), moved),
        (lambda: tablet.page.keyboard.press("Control+z"), before),
    ):
        # Only its own answer, because the page also reports every few seconds whether it can sound an alarm.
        with tablet.page.expect_response(
            lambda answer: answer.request.method == "PUT" and answer.url.endswith("/api/plan")
        ):
            act()
        assert entry() == pytest.approx(expected, abs=1e-9)
        expect(tablet.page.get_by_test_id("redo" if expected is before else "undo")).to_be_enabled()
    tablet.tap("activate")
    tablet.sees("is-active")


def dragged_on_several_planes(tablet: Tablet) -> None:
    """Drag both ends and the middle of a channel on flat and oblique slices; then discard it."""
    tablet.tap("part-channel")
    tablet.tap("move-channel")
    for plane in ("sagittal", "along", "across"):
        tablet.tap(f"enlarge-{plane}")
        expect(tablet.page.locator(f".planes-large [data-plane={plane}]")).not_to_have_attribute(
            "data-late", "true", timeout=tablet.patience_ms
        )
        for moved in ("entry", "target", "whole"):
            before = _draft(tablet)
            _dragged(tablet, f"handle-{moved}", (12.0, 9.0))
            shift = _draft(tablet) - before
            expected = np.array([moved != "target", moved != "entry"]) * 15.0 / _px_per_mm(tablet)
            # Positions are stated to 0.1 mm.
            assert np.linalg.norm(shift, axis=1) == pytest.approx(expected, abs=0.2), (plane, moved)
    tablet.tap("place-at-cross")
    tablet.tap("discard-channel")
    tablet.sees("move-channel")


def _draft(tablet: Tablet) -> Any:  # noqa: ANN401  an array
    """Entry and end (2, 3) of the channel that is being moved."""
    stated = [
        tablet.page.get_by_test_id(f"handle-{end}").get_attribute("aria-valuetext") or ""
        for end in ("entry", "target")
    ]
    return np.array([[float(one) for one in point.split(", ")] for point in stated])


def _dragged(tablet: Tablet, handle: str, by_px: tuple[float, float]) -> None:
    box = tablet.page.get_by_test_id(handle).locator(".draw-handle-touch").bounding_box()
    assert box is not None
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    mouse = tablet.page.mouse
    mouse.move(x, y)
    mouse.down()
    mouse.move(x + by_px[0], y + by_px[1], steps=2)
    mouse.up()


def _px_per_mm(tablet: Tablet) -> float:
    return float(tablet.page.evaluate(PX_PER_MM))


def measured_by_hand(tablet: Tablet) -> None:
    """Measure a distance and a right angle on the large slice, and remove the measurement."""
    page = tablet.page
    hands = page.get_by_role("toolbar", name="Slice tools")
    hands.get_by_text("Measure", exact=True).tap()
    large = page.locator(".planes-large .slice-stage").bounding_box()
    assert large is not None
    cross = _cross(tablet)
    x, y = large["x"] + 0.4 * large["width"], large["y"] + 0.4 * large["height"]
    for to_x, to_y in ((x, y), (x + 90, y), (x + 90, y + 60)):
        page.touchscreen.tap(to_x, to_y)
    px_per_mm = _px_per_mm(tablet)
    tablet.reads("measurement", "°")
    first_mm, second_mm, angle_deg = map(
        float, re.findall(r"[\d.]+", page.get_by_test_id("measurement").inner_text())
    )
    assert (first_mm, second_mm) == pytest.approx((90 / px_per_mm, 60 / px_per_mm), abs=0.06)
    assert angle_deg == 90.0
    tablet.tap("remove-measurement")
    expect(page.get_by_test_id("measurement-drawn")).to_have_count(0)
    # The taps measured, and did not move the cross.
    assert _cross(tablet) == pytest.approx(cross)
    hands.get_by_text("Scroll", exact=True).tap()


def with_lines(tablet: Tablet) -> None:
    """Lay the proposed lines, with the needles 20.5 mm to each side."""
    tablet.tap("part-lines")
    tablet.tap("propose-slice")
    tablet.tap("apart-more")
    tablet.tap("lay-lines")
    tablet.sees("reference")
    (reference,) = _plan(tablet)["plan"]["vertebrae"][0]["references"]
    assert reference["apart_mm"] == 20.5
    assert [line["name"] for line in reference["lines"]] == ["middle", "left", "right"]


def with_landmarks(tablet: Tablet, truth: dict[str, Any]) -> None:
    """Set one landmark at the cross by its usual name, then use those of the rehearsal."""
    tablet.tap("part-landmarks")
    cross = _cross(tablet)
    # The button moves when the catalogue has loaded.
    tablet.reads("landmark-count", "needed at least")
    with tablet.uncounted():
        tablet.tap("set-landmark")
        tablet.page.get_by_role("button", name="spinous process, upper end").tap()
        tablet.reads("landmark-count", "1 set · needed at least 3")
        (vertebra,) = _plan(tablet)["plan"]["vertebrae"]
        assert vertebra["landmarks"][0]["point_lps_mm"] == pytest.approx(cross, abs=0.06)
    tablet.tap("rehearsed-landmarks")
    tablet.reads("landmark-count", f"{len(truth['landmarks']) + 1} set")
    tablet.looked_at("plan-landmarks")


def _measured_where_it_is(tablet: Tablet, side: str, channel: dict[str, Any]) -> None:
    """Tap a pedicle, measure it, lay its channel and use the proposed screw."""
    tablet.tap("part-pedicle")
    tablet.tap_on(tablet.page.get_by_test_id("side").get_by_text(side.capitalize(), exact=True), side)
    entry, target = np.array(channel["entry_lps_mm"]), np.array(channel["target_lps_mm"])
    _put_cross(tablet, entry + 0.35 * (target - entry))
    tablet.tap("measure")
    tablet.sees("pedicle-numbers")
    expect(tablet.page.get_by_test_id("pedicle-numbers")).to_be_in_viewport()
    tablet.tap("lay-channel")
    tablet.reads("screw-numbers", "Gertzbein-Robbins A")
    tablet.reads("clearance", "to the pedicle's measured wall")
    expect(tablet.page.locator(".planes-large [data-clearance=ample]").first).to_be_attached()
    (vertebra,) = _plan(tablet)["plan"]["vertebrae"]
    laid = next(one for one in vertebra["channels"] if one["side"] == side)["channel"]
    assert np.linalg.norm(
        np.cross(entry - laid["entry_in_vertebra_mm"], target - entry)
    ) < 1.5 * np.linalg.norm(target - entry)


def _put_cross(tablet: Tablet, wanted: Any) -> None:  # noqa: ANN401  an array
    """Scroll to the slice, tap the point, and adjust the cross with the arrows."""
    page = tablet.page
    for _ in range(100):
        below = wanted[2] - _cross(tablet)[2]
        if abs(below) <= 0.5:
            break
        tablet.tap("slice-on" if below > 0 else "slice-back")
    # A tap refers to the displayed slice, which may still be an earlier one.
    _slice_stands(tablet)
    place = page.locator(".planes-large [data-testid=cross] circle").bounding_box()
    assert place is not None
    away_px = (wanted - _cross(tablet)) * page.evaluate(PX_PER_MM)
    page.touchscreen.tap(
        place["x"] + place["width"] / 2 + away_px[0], place["y"] + place["height"] / 2 + away_px[1]
    )
    tablet.taps.append("point")
    _slice_stands(tablet)
    # The test compares with the truth to 0.7 mm; a measurement may start from anywhere in the pedicle.
    with tablet.uncounted():
        for axis, (less, more) in enumerate((("cross-left", "cross-right"), ("cross-up", "cross-down"))):
            for _ in range(6):
                off = wanted[axis] - _cross(tablet)[axis]
                if abs(off) <= 0.3:
                    break
                tablet.tap(more if off > 0 else less)
    assert np.abs(_cross(tablet) - wanted).max() < 0.7


def _slice_stands(tablet: Tablet) -> None:
    expect(tablet.page.get_by_test_id("slice-axial")).not_to_have_attribute(
        "data-late", "true", timeout=tablet.patience_ms
    )


def _cross(tablet: Tablet) -> Any:  # noqa: ANN401  an array
    """Position of the cross as displayed on the page."""
    said = tablet.page.get_by_test_id("cursor").inner_text()
    return np.array([float(one) for one in re.findall(r"[xyz] (-?[\d.]+)", said)])


def _plan(tablet: Tablet) -> Any:  # noqa: ANN401  JSON
    """Plan as stored on the server."""
    return tablet.asks("/api/plan")
