"""The page can be installed as an app, from its own files, and never shows an old version."""

import json
import re
from pathlib import Path

import cv2
import pytest

WEB = Path(__file__).resolve().parents[2] / "web"
MANIFEST = json.loads((WEB / "public" / "manifest.webmanifest").read_text(encoding="utf-8"))
INDEX = (WEB / "index.html").read_text(encoding="utf-8")
PICTURES = [icon for icon in MANIFEST["icons"] if icon["type"] == "image/png"]


@pytest.mark.parametrize("icon", PICTURES, ids=lambda icon: Path(icon["src"]).stem)
def test_an_icon_has_the_size_that_is_said(icon: dict[str, str]) -> None:
    picture = cv2.imread(str(WEB / "public" / icon["src"].removeprefix("/")), cv2.IMREAD_UNCHANGED)
    assert picture is not None
    assert f"{picture.shape[1]}x{picture.shape[0]}" == icon["sizes"]


def test_what_a_browser_asks_of_an_app_is_there() -> None:
    assert {icon["sizes"] for icon in PICTURES} >= {"192x192", "512x512"}
    assert "maskable" in {icon["purpose"] for icon in PICTURES}
    assert MANIFEST["start_url"].startswith(MANIFEST["scope"])
    assert "not a medical device" in MANIFEST["description"]
    assert 'rel="manifest" href="/manifest.webmanifest"' in INDEX


def test_its_colour_is_the_page_s_ground() -> None:
    ground = re.search(
        r"--ground: (#\w+);", (WEB / "src" / "theme" / "tokens.css").read_text(encoding="utf-8")
    )
    reported = re.search(r'name="theme-color" content="(#\w+)"', INDEX)
    assert ground is not None
    assert reported is not None
    assert {MANIFEST["theme_color"], MANIFEST["background_color"], ground[1]} == {reported[1]}


def test_there_is_no_service_worker_between_page_and_server() -> None:
    sources = [*(WEB / "src").rglob("*.ts"), *(WEB / "src").rglob("*.tsx"), WEB / "index.html"]
    assert [path.name for path in sources if "serviceWorker" in path.read_text(encoding="utf-8")] == []
