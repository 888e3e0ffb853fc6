"""The names under which the supervisor's page reads the numbers of a registration are those of the server."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
ROWS = ROOT / "web/src/supervisor/registrationRows.ts"
STEPS = ROOT / "server/procedure/registration"


def test_every_number_that_a_supervisor_reads_is_stored_by_a_step() -> None:
    page = ROWS.read_text(encoding="utf-8")
    (names,) = re.findall(r"const NAMES.*?\[(.*?)\];", page, re.DOTALL)
    (limits,) = re.findall(r"const LIMIT_OF.*?\{(.*?)\};", page, re.DOTALL)
    read = {*re.findall(r'"(\w+)"', names), *re.findall(r'"(\w+)"', limits)}
    assert read
    steps = "".join(path.read_text(encoding="utf-8") for path in STEPS.glob("*.py"))
    stored = {*re.findall(r'"(\w+)"\s*:', steps), *re.findall(r'\["(\w+)"\]', steps)}
    assert read <= stored, f"registrationRows.ts reads {sorted(read - stored)}, which no step stores"
