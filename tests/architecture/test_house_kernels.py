"""Kernels whose name begins with an underscore have no wrapper for Python, which crashes if it calls them."""

import ast
from collections.abc import Iterator
from pathlib import Path
from typing import TypeGuard

import pytest

ROOT = Path(__file__).parents[2]
KERNELS = sorted((ROOT / "tracker").rglob("*_kernels.py"))


def _is_compiled(node: ast.stmt) -> TypeGuard[ast.FunctionDef]:
    return isinstance(node, ast.FunctionDef) and any(
        isinstance(one, ast.Name) and one.id == "compiled" for one in node.decorator_list
    )


def _private_calls_of_python(source: str) -> Iterator[str]:
    """Yield the private kernels of a module that something else than its kernels names."""
    module = ast.parse(source)
    private = {node.name for node in module.body if _is_compiled(node) and node.name.startswith("_")}
    for node in module.body:
        if not _is_compiled(node):
            yield from (one.id for one in ast.walk(node) if isinstance(one, ast.Name) and one.id in private)


def _private_imports(source: str) -> Iterator[str]:
    if "_kernels import" not in source:
        return
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.ImportFrom) and (node.module or "").endswith("_kernels"):
            yield from (one.name for one in node.names if one.name.startswith("_"))


@pytest.mark.parametrize("path", KERNELS, ids=lambda path: path.stem)
def test_python_calls_no_private_kernel_of_its_own_module(path: Path) -> None:
    assert not list(_private_calls_of_python(path.read_text()))


def test_no_module_and_no_test_imports_a_private_kernel() -> None:
    sources = [path for folder in ("tracker", "server", "tests") for path in (ROOT / folder).rglob("*.py")]
    assert not [path.name for path in sources if list(_private_imports(path.read_text()))]


def test_a_private_kernel_that_python_calls_is_noticed() -> None:
    kernel = "@compiled\ndef _one(x):\n    return x\n"
    assert list(_private_calls_of_python(f"{kernel}\ndef other(x):\n    return _one(x)\n")) == ["_one"]
    assert list(_private_imports("from tracker.a_kernels import _one, two")) == ["_one"]
    assert not list(_private_calls_of_python(f"{kernel}\n@compiled\ndef two(x):\n    return _one(x)\n"))
