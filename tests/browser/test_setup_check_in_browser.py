"""An insufficient set-up is reported before navigation with remedies, and in the headline."""

from collections.abc import Callable
from typing import Any

import pytest
from playwright.sync_api import Route, expect

from tests.browser.theatre import PATIENCE_MS, Theatre, WatchedPage

pytestmark = pytest.mark.browser

Watch = Callable[..., WatchedPage]
expect.set_options(timeout=PATIENCE_MS)


def error(error_mm: float, tolerance_mm: float) -> dict[str, Any]:
    return {
        "entry_95_mm": error_mm - 0.1,
        "isthmus_95_mm": error_mm,
        "error_95_mm": error_mm,
        "tolerance_mm": tolerance_mm,
        "suffices": error_mm <= tolerance_mm,
    }


CHECK = {
    "basis": "registration",
    "method": "points",
    "vertebra": "L3",
    "side": "left",
    "diameter_mm": 6.5,
    "tool": "drill",
    "landmark_sd_mm": None,
    "found": error(1.2, 0.5),
    "remedies": [
        {"kind": "more_landmarks", "expected": error(0.9, 0.5), "landmarks": 9, "diameter_mm": None},
        {"kind": "surface_sweep", "expected": None, "landmarks": None, "diameter_mm": None},
        {"kind": "thinner_screw", "expected": error(1.2, 1.25), "landmarks": None, "diameter_mm": 5.0},
    ],
}


def test_the_overview_names_the_figures_and_each_remedy_with_its_own(theatre: Theatre, watch: Watch) -> None:
    watched = watch(theatre)

    def checked(route: Route) -> None:
        answer = route.fetch()
        route.fulfill(response=answer, json={**answer.json(), "setup_check": CHECK})

    watched.page.route("**/api/procedure", checked)
    page = watched.open("operator/navigate?lang=en")
    note = page.get_by_test_id("setup-check")
    expect(note).to_contain_text("error at the isthmus at least 1.20 mm (95 %), 0.50 mm to the wall")
    expect(page.get_by_test_id("setup-remedies").get_by_role("listitem")).to_have_text(
        [
            "A surface sweep: the error is known only afterwards.",
            "Screw of 5.0 mm: 1.25 mm to the wall, enough at best.",
        ]
    )
    page = watched.open("operator/navigate?lang=de")
    expect(note).to_contain_text("Fehler am Isthmus mindestens 1,20 mm (95 %), 0,50 mm bis zur Wand")


def test_without_a_check_the_overview_omits_it(theatre: Theatre, watch: Watch) -> None:
    page = watch(theatre).open("operator/navigate?lang=en")
    expect(page.get_by_test_id("navigate")).to_be_visible()
    expect(page.get_by_test_id("setup-check")).to_have_count(0)


def test_the_headline_tells_the_set_up_from_the_image(theatre: Theatre, watch: Watch) -> None:
    page = watch(theatre).open("theatre?lang=en")
    theatre.tell("insufficient")
    verdict = page.get_by_test_id("verdict")
    expect(verdict).to_contain_text("SET-UP INSUFFICIENT ±2.")
    expect(verdict).to_have_attribute("data-tone", "warning")
    expect(page.get_by_test_id("alarm-top")).to_contain_text("Register with more landmarks")
