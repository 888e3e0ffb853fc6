"""Finds by the syntax tree the phrases that are given as values of errors, and all texts in the code."""

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from string import Formatter

from server.texts.errors.phrases import PHRASES
from tests.server.texts.error_sites import ROOT, parsed

Function = ast.FunctionDef


def bare_shape(template: str) -> str:
    """Return a template without names, formats and conversions of its values."""
    return "".join(
        literal + ("" if name is None else "{}") for literal, name, *_ in Formatter().parse(template)
    )


def phrases_of(text: ast.expr) -> Iterator[str]:
    """Return the shapes of a literal; of a conditional expression, of both."""
    if isinstance(text, ast.IfExp):
        yield from phrases_of(text.body)
        yield from phrases_of(text.orelse)
    elif isinstance(text, ast.Constant) and isinstance(text.value, str):
        yield text.value
    elif isinstance(text, ast.JoinedStr):
        yield "".join(str(part.value) if isinstance(part, ast.Constant) else "{}" for part in text.values)


@cache
def modules() -> dict[Path, ast.Module]:
    """Return the syntax trees of tracker and server without its texts."""
    paths = [path for folder in ("server", "tracker") for path in sorted((ROOT / folder).rglob("*.py"))]
    return {path: parsed(path) for path in paths if "texts" not in path.parts}


@cache
def texts_in_code() -> str:
    """Return all texts in the code, a line each."""
    return "\n".join(
        str(node.value)
        for tree in modules().values()
        for node in ast.walk(tree)
        if isinstance(node, ast.Constant) and isinstance(node.value, str)
    )


def given_phrases() -> Iterator[tuple[str, str, str]]:
    """Return module, name and shape of each phrase in a context that can be traced to a literal.

    It is one where it is given, in an assignment to the variable that is given, in a return of the function
    that this variable is assigned from, or in the calls of the function that has it as an argument.
    """
    for path, tree in modules().items():
        text = path.read_text()
        if "BoardNotFound(" not in text and not any(f'"{name}"' in text for name in PHRASES):
            continue
        functions = [node for node in ast.walk(tree) if isinstance(node, Function)]
        for function in functions:
            for name, value in _contexts(function):
                for shape in _traced(value, function, functions, tree):
                    yield str(path.relative_to(ROOT)), name, shape


def _contexts(function: Function) -> Iterator[tuple[str, ast.expr]]:
    for node in ast.walk(function):
        if isinstance(node, ast.Dict):
            for key, value in zip(node.keys, node.values, strict=True):
                if isinstance(key, ast.Constant) and key.value in PHRASES:
                    yield str(key.value), value
        elif isinstance(node, ast.Call) and _is_call_of("BoardNotFound", node):
            # Steps give it as `board_problem`.
            yield from (("board_problem", one.value) for one in node.keywords if one.arg == "sentence")


def _traced(
    value: ast.expr, function: Function, functions: list[Function], tree: ast.Module
) -> Iterator[str]:
    yield from phrases_of(value)
    if isinstance(value, ast.Call) and isinstance(value.func, ast.Name):
        for called in functions:
            if called.name == value.func.id:
                returns = [node for node in ast.walk(called) if isinstance(node, ast.Return)]
                yield from (shape for one in returns if one.value for shape in phrases_of(one.value))
    if not isinstance(value, ast.Name):
        return
    for node in ast.walk(function):
        if isinstance(node, ast.Assign) and any(
            isinstance(target, ast.Name) and target.id == value.id for target in node.targets
        ):
            yield from _traced(node.value, function, functions, tree)
    names = [one.arg for one in (*function.args.args, *function.args.kwonlyargs)]
    if value.id in names:
        index = names.index(value.id) - (names[0] == "self")
        for node in ast.walk(tree):
            if isinstance(node, ast.Call) and _is_call_of(function.name, node):
                named = [one.value for one in node.keywords if one.arg == value.id]
                for given in (*node.args[index : index + 1], *named):
                    yield from phrases_of(given)


def _is_call_of(name: str, call: ast.Call) -> bool:
    return (isinstance(call.func, ast.Name) and call.func.id == name) or (
        isinstance(call.func, ast.Attribute) and call.func.attr == name
    )


def listed_shapes(name: str) -> set[str]:
    """Return the shapes of the templates of a phrase."""
    return {bare_shape(text["en"]) for text in PHRASES[name]}
