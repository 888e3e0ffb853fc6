"""`make house` finds what it counts: circles, words, and nothing in code that has none."""

from pathlib import Path

import pytest

from tests.house.imports import circles, python_imports, typescript_imports
from tests.house.words import remaining_words


def written(folder: Path, files: dict[str, str]) -> list[Path]:
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)
    return [folder / name for name in files]


@pytest.mark.parametrize(
    ("text_of_b", "expected"),
    [
        pytest.param("from pkg.a import f\n", [["pkg.a", "pkg.b"]], id="at module level"),
        pytest.param("import pkg.a\n", [["pkg.a", "pkg.b"]], id="a plain import"),
        pytest.param("class C:\n    from pkg.a import f\n", [["pkg.a", "pkg.b"]], id="in a class body"),
        pytest.param("def f():\n    from pkg.a import f\n", [], id="inside a function"),
        pytest.param("if TYPE_CHECKING:\n    from pkg.a import f\n", [], id="for type checkers only"),
    ],
)
def test_python_circle(tmp_path: Path, text_of_b: str, expected: list[list[str]]) -> None:
    paths = written(
        tmp_path, {"pkg/__init__.py": "", "pkg/a.py": "from pkg import b\n", "pkg/b.py": text_of_b}
    )
    assert circles(python_imports(tmp_path, paths)) == expected


@pytest.mark.parametrize(
    ("text_of_b", "expected"),
    [
        pytest.param('import { f } from "./a";\n', [["a.tsx", "b.ts"]], id="a value"),
        pytest.param('import {\n  f,\n  g,\n} from "./a";\n', [["a.tsx", "b.ts"]], id="over several lines"),
        pytest.param('export { f } from "./a";\n', [["a.tsx", "b.ts"]], id="passed on"),
        pytest.param('import type { F } from "./a";\n', [], id="a type"),
        pytest.param('import { f } from "a";\n', [], id="a package"),
    ],
)
def test_circle_in_the_page(tmp_path: Path, text_of_b: str, expected: list[list[str]]) -> None:
    paths = written(tmp_path, {"a.tsx": 'import { g } from "./b";\n', "b.ts": text_of_b})
    assert circles(typescript_imports(tmp_path, paths)) == expected


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        pytest.param("a.py", "told_ms = MAX_KEPT\n", {"told": 1, "kept": 1}, id="in names"),
        pytest.param("a.py", "class HeldTool: ...\n", {"held": 1}, id="in a class"),
        pytest.param("a.py", '# it was told\nx = "kept"\n', {}, id="not in prose"),
        pytest.param("a.py", "least_squares(most_common())\n", {}, id="not in names of libraries"),
        pytest.param("a.py", "least_trimmed_squares(found)\n", {}, id="not in standard terms"),
        pytest.param("a.py", "wait_at_most_s = AT_LEAST\n", {}, id="not in the phrase at most"),
        pytest.param("a.tsx", "const atMost = countAtLeast;\n", {}, id="not in the phrase in the page"),
        pytest.param("a.py", "format_most(1)\n", {"most": 1}, id="in a word that ends in at"),
        pytest.param("a.py", "def test_what_is_told(): ...\n", {}, id="not in a test's sentence"),
        pytest.param("a.tsx", 'const whoAsked = 1; // told\nsay("kept");\n', {"asked": 1}, id="in the page"),
    ],
)
def test_former_words(tmp_path: Path, name: str, text: str, words: dict[str, int]) -> None:
    assert dict(remaining_words(written(tmp_path, {name: text}))) == words
