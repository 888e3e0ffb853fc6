"""Each error for which the page has a button to another page is one of the server, and each page exists."""

import re
from pathlib import Path

from server.texts.errors.catalogue import MESSAGES

ROOT = Path(__file__).parents[2]
TABLE = ROOT / "web/src/rest/remedyPage.ts"
PAGES = ROOT / "web/src/operator/pages.ts"


def test_every_code_with_a_button_is_an_error_of_the_server_and_leads_to_a_page() -> None:
    (table,) = re.findall(r"CODES_OF_PAGE.*?= \{(.*?)\n\};", TABLE.read_text(encoding="utf-8"), re.DOTALL)
    codes = re.findall(r'"([A-Z_]+)"', table)
    pages = set(re.findall(r"^  (\w+): \[", table, re.MULTILINE))
    page = TABLE.read_text(encoding="utf-8")
    (steps,) = re.findall(r"/\^\(([A-Z|]+)\)_\(\?:([A-Z_|]+)\)\$/", page)
    codes += [f"{step}_{state}" for step in steps[0].split("|") for state in steps[1].split("|")]
    assert len(codes) == len(set(codes)) > len(pages) > 1
    assert set(codes) <= set(MESSAGES), sorted(set(codes) - set(MESSAGES))
    assert pages <= set(re.findall(r'\{ name: "(\w+)",', PAGES.read_text(encoding="utf-8")))
