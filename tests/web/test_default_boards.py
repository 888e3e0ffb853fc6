"""The page proposes the boards that the rehearsal shows, and names their sizes."""

from dataclasses import fields
from pathlib import Path

import pytest

from tracker.rehearsal.boards import BOARD_FROM_KIND
from tracker.rehearsal.settings import BoardKind

SOURCES = Path(__file__).parents[2] / "web/src"


@pytest.mark.parametrize("kind", list(BoardKind))
def test_the_page_proposes_the_board_of_the_rehearsal(kind: BoardKind) -> None:
    board = BOARD_FROM_KIND[kind]
    lengths = {field.name: getattr(board, field.name) for field in fields(board)}
    proposed = (SOURCES / "operator/camera/board.ts").read_text().split(f'case "{kind}":')[1].split("};")[0]
    for name, value in lengths.items():
        if isinstance(value, int | float):
            assert f"{name}: {value:g}" in proposed, f"web/src/operator/camera/board.ts: {name} of {kind}"
    side_mm = next(value for name, value in lengths.items() if name.endswith("_mm"))
    for language in ("en", "de"):
        texts = (SOURCES / f"texts/case/{language}.ts").read_text()
        line = next(line for line in texts.splitlines() if line.strip().startswith(f"{kind}: "))
        size = f"{board.columns} × {board.rows}, {side_mm:g} mm"
        assert size in line, f"write {size} for {kind} into web/src/texts/case/{language}.ts"
