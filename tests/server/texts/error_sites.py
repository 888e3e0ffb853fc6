"""Finds by the syntax tree where errors are raised, and the templates of their messages and remedies."""

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

# Fields of `Problem` and `Remark`, which are given by name.
PROBLEM = ("code", "message", "remedy")
# Only a terminal shows their errors, which are in English.
ENGLISH = ("server/cli/", "server/config_file.py", "server/pose_file/", "server/security/tls/selection.py")
ROOT = Path(__file__).resolve().parents[3]
CODE = re.compile(r"[A-Z][A-Z0-9]*(_[A-Z0-9]+)+")
# Names of values are left out: a template in the catalogue names what an f-string computes.
FIELD = re.compile(r"\{[^{}!:]*((?:![rs])?(?::[^{}]*)?)\}")


@dataclass(frozen=True, slots=True)
class ErrorSite:
    """Code, message and remedy as written; a part is None where it is not a literal.

    So are the names of the values that it gives by name (`context`).
    """

    where: str
    code: str
    message: str | None
    remedy: str | None
    names: frozenset[str] | None


@cache
def error_sites() -> tuple[ErrorSite, ...]:
    """Return all places at which an error, problem or remark with a literal code is made.

    Errors of the command line and of a start that fails are left out.
    """
    paths = [path for folder in ("server", "tracker") for path in sorted((ROOT / folder).rglob("*.py"))]
    shown = [path for path in paths if not str(path.relative_to(ROOT)).startswith(ENGLISH)]
    return tuple(site for path in shown for site in _sites_in(path))


@cache
def parsed(path: Path) -> ast.Module:
    """Return the syntax tree of a module."""
    return ast.parse(path.read_text())


def _sites_in(path: Path) -> Iterator[ErrorSite]:
    tree = parsed(path)
    constants = {
        target.id: node.value
        for node in tree.body
        if isinstance(node, ast.Assign)
        for target in node.targets
        if isinstance(target, ast.Name)
    }
    for node in ast.walk(tree):
        if not isinstance(node, ast.Call):
            continue
        if len(node.args) >= 3:
            given, message, remedy = node.args[:3]
        elif isinstance(node.func, ast.Name) and node.func.id in {"Problem", "Remark"}:
            named = {one.arg: one.value for one in node.keywords}
            given, message, remedy = (named.get(part) for part in PROBLEM)
        else:
            continue
        for code in [given.body, given.orelse] if isinstance(given, ast.IfExp) else [given]:
            if isinstance(code, ast.Constant) and isinstance(code.value, str) and CODE.fullmatch(code.value):
                where = f"{path.relative_to(ROOT)}:{node.lineno}"
                yield ErrorSite(
                    where, code.value, _shape(message, constants), _shape(remedy, constants), _names(node)
                )


def _names(call: ast.Call) -> frozenset[str] | None:
    given = [*call.args[3:4], *(one.value for one in call.keywords if one.arg == "context")]
    if not given:
        # A helper in place of the class may add values of its own.
        return frozenset() if isinstance(call.func, ast.Name) and call.func.id[0].isupper() else None
    if isinstance(given[0], ast.Dict) and all(isinstance(key, ast.Constant) for key in given[0].keys):
        return frozenset(str(key.value) for key in given[0].keys if isinstance(key, ast.Constant))
    return None


def shape_of(template: str) -> str:
    """Return a template without the names of its values, for the comparison with an f-string."""
    return FIELD.sub(r"{\1}", template)


def _shape(node: ast.expr | None, constants: dict[str, ast.expr]) -> str | None:
    if isinstance(node, ast.Name):
        node = constants.get(node.id, node)
    if isinstance(node, ast.Constant):
        return str(node.value)
    if not isinstance(node, ast.JoinedStr):
        return None
    return "".join(
        str(part.value) if isinstance(part, ast.Constant) else _field(part) for part in node.values
    )


def _field(part: ast.expr) -> str:
    assert isinstance(part, ast.FormattedValue)
    conversion = "" if part.conversion < 0 else f"!{chr(part.conversion)}"
    spec = "" if part.format_spec is None else ast.unparse(part.format_spec)[2:-1]
    return f"{{{conversion}{':' + spec if spec else ''}}}"
