"""Print figures on the structure of the code: sizes, small files, circles, long signatures, former words.

python -m tests.house [ROOT]
"""

import ast
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from tests.house.imports import circles, python_imports, typescript_imports
from tests.house.words import STANDARD_TERMS, remaining_words

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = ("tracker", "server", "tests", "web/src")
SMALL_LINES = 40
MAX_PARAMETERS = 8
# Sizes above which a file needs a reason; none is forbidden.
LONG_FILE_LINES = 400
LONG_FUNCTION_LINES = 60
# This many equal lines in two places are a copy.
COPIED_LINES = 6
# Generated from the server's schema.
GENERATED = "src/api/"


def main() -> None:
    """Measure the working tree at ROOT and print the tables."""
    root = Path(sys.argv[1]).resolve() if len(sys.argv) > 1 else ROOT
    files = {folder: _files(root / folder) for folder in FOLDERS}
    lines = {
        path: path.read_text(encoding="utf-8").splitlines() for paths in files.values() for path in paths
    }
    _print_sizes(root, files, lines)
    product = files["tracker"] + files["server"]
    everything = product + files["tests"] + files["web/src"]
    sources = [path for path in product if path.suffix == ".py"]
    tests = [path for path in files["tests"] if path.suffix == ".py"]
    _print_group("circles of imports, Python", circles(python_imports(root, sources + tests)))
    page = [path for path in files["web/src"] if path.suffix in {".ts", ".tsx"}]
    _print_group("circles of imports, page", circles(typescript_imports(root, page)))
    long_files = [path for path in product + page if len(lines[path]) > LONG_FILE_LINES]
    _print_group(
        f"product files of more than {LONG_FILE_LINES} lines",
        [[f"{path.relative_to(root)} ({len(lines[path])})"] for path in long_files],
    )
    _print_group(f"functions of more than {LONG_FUNCTION_LINES} lines", _long_functions(root, sources))
    _print_group(f"functions of more than {MAX_PARAMETERS} parameters", _long_signatures(root, sources))
    _print_group(f"blocks of {COPIED_LINES} equal lines in two files", _copies(root, product, lines))
    words = remaining_words([path for path in everything if path.suffix in {".py", ".ts", ".tsx"}])
    _write(f"\nwords of the former dialect in names: {words.total()}")
    for word, count in words.most_common():
        _write(f"  {count:5d} {word} (say: {STANDARD_TERMS[word]})")
    architecture = (root / "ARCHITECTURE.md").read_text(encoding="utf-8").splitlines()
    _write(f"\nARCHITECTURE.md: {len(architecture)} lines")


def _files(folder: Path) -> list[Path]:
    suffixes = {".py", ".ts", ".tsx", ".css", ".js"}
    return sorted(
        path for path in folder.rglob("*") if path.suffix in suffixes and GENERATED not in path.as_posix()
    )


def _print_sizes(root: Path, files: dict[str, list[Path]], lines: dict[Path, list[str]]) -> None:
    _write(f"{'folder':40s} {'files':>6s} {'lines':>7s} {f'< {SMALL_LINES}':>6s} {'one-file packages':>18s}")
    for folder, paths in files.items():
        groups = {folder: paths}
        for path in paths:
            parts = path.relative_to(root / folder).parts
            if len(parts) > 1:
                groups.setdefault(f"{folder}/{parts[0]}", []).append(path)
        for name, group in groups.items():
            small = [path for path in group if path.name != "__init__.py" and len(lines[path]) < SMALL_LINES]
            total = sum(len(lines[path]) for path in group)
            _write(f"{name:40s} {len(group):6d} {total:7d} {len(small):6d} {_one_file_packages(group):18d}")


def _one_file_packages(paths: list[Path]) -> int:
    packages = Counter(path.parent for path in paths if path.suffix == ".py" and path.name != "__init__.py")
    with_init = {path.parent for path in paths if path.name == "__init__.py"}
    parents = {path.parent.parent for path in paths}
    return sum(1 for folder, count in packages.items() if count == 1 and folder in with_init - parents)


def _long_signatures(root: Path, paths: list[Path]) -> list[list[str]]:
    found = []
    for path, node in _functions(paths):
        count = len(node.args.posonlyargs + node.args.args + node.args.kwonlyargs)
        if count > MAX_PARAMETERS and not path.stem.endswith("kernels"):
            found.append([f"{path.relative_to(root)}:{node.lineno} {node.name} ({count})"])
    return found


def _long_functions(root: Path, paths: list[Path]) -> list[list[str]]:
    found = []
    for path, node in _functions(paths):
        length = (node.end_lineno or node.lineno) - node.lineno + 1
        if length > LONG_FUNCTION_LINES:
            found.append([f"{path.relative_to(root)}:{node.lineno} {node.name} ({length})"])
    return found


def _functions(paths: list[Path]) -> Iterator[tuple[Path, ast.FunctionDef | ast.AsyncFunctionDef]]:
    for path in paths:
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                yield path, node


def _copies(root: Path, paths: list[Path], lines: dict[Path, list[str]]) -> list[list[str]]:
    places: dict[tuple[str, ...], set[str]] = {}
    for path in paths:
        code = [line.strip() for line in lines[path]]
        code = [
            line for line in code if line and not line.startswith(("#", "from ", "import ", ")", "]", "}"))
        ]
        for start in range(len(code) - COPIED_LINES + 1):
            places.setdefault(tuple(code[start : start + COPIED_LINES]), set()).add(
                str(path.relative_to(root))
            )
    return [
        list(pair) for pair in sorted({tuple(sorted(where)) for where in places.values() if len(where) > 1})
    ]


def _print_group(title: str, groups: list[list[str]]) -> None:
    _write(f"\n{title}: {len(groups)}")
    for group in groups:
        _write("  " + ", ".join(group))


def _write(line: str) -> None:
    sys.stdout.write(line + "\n")


if __name__ == "__main__":
    main()
