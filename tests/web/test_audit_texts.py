"""The page has a text for every action in the audit log."""

from pathlib import Path

import pytest

from server.security.access_rules import ACCESS_RULES

TEXTS = Path(__file__).resolve().parents[2] / "web" / "src" / "texts" / "audit"


@pytest.mark.parametrize("language", ["en", "de"])
def test_each_audited_route_has_a_text(language: str) -> None:
    texts = (TEXTS / f"{language}.ts").read_text(encoding="utf-8")
    missing = [rule.name for rule in ACCESS_RULES if rule.is_audited and f'"{rule.name}":' not in texts]
    assert missing == [], f"say in web/src/texts/audit/{language}.ts what somebody did by these requests"
