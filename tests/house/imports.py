"""Which file imports which, in Python and in the page."""

import ast
import re
from pathlib import Path

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components

Graph = dict[str, set[str]]
TYPESCRIPT_IMPORT = re.compile(
    r"^(?:import|export)\b(?! type)[^;]*?from \"(\.[^\"]+)\"", re.MULTILINE | re.DOTALL
)


def python_imports(root: Path, paths: list[Path]) -> Graph:
    """Module -> modules of the project that it imports when it is loaded."""
    modules = {module_name(root, path): path for path in paths}
    graph: Graph = {}
    for name, path in modules.items():
        graph[name] = set()
        for node in _executed(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and node.module and not node.level:
                submodules = {f"{node.module}.{alias.name}" for alias in node.names} & modules.keys()
                graph[name] |= submodules or ({node.module} & modules.keys())
            elif isinstance(node, ast.Import):
                graph[name] |= {alias.name for alias in node.names} & modules.keys()
    return graph


def typescript_imports(root: Path, paths: list[Path]) -> Graph:
    """File -> files of the page that it imports, types left out."""
    known = {path.resolve(): str(path.relative_to(root)) for path in paths}
    graph: Graph = {}
    for path, name in known.items():
        targets = TYPESCRIPT_IMPORT.findall(path.read_text(encoding="utf-8"))
        bases = [(path.parent / target).resolve() for target in targets]
        candidates = [base.with_name(base.name + suffix) for base in bases for suffix in (".ts", ".tsx")]
        graph[name] = {known[one] for one in candidates if one in known}
    return graph


def circles(graph: Graph) -> list[list[str]]:
    """Groups of files that import each other in a circle (strongly connected components)."""
    names = sorted(graph)
    index = {name: number for number, name in enumerate(names)}
    edges = [
        (index[name], index[target])
        for name, targets in graph.items()
        for target in targets
        if target != name
    ]
    rows, columns = np.array(edges or [(0, 0)]).T
    matrix = csr_matrix((np.ones(len(rows)), (rows, columns)), shape=(len(names), len(names)))
    _, labels = connected_components(matrix, directed=True, connection="strong")
    groups = [
        [name for name, label in zip(names, labels, strict=True) if label == one] for one in set(labels)
    ]
    return sorted(group for group in groups if len(group) > 1)


def module_name(root: Path, path: Path) -> str:
    """Return the dotted name of a Python file."""
    parts = path.relative_to(root).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def _executed(tree: ast.AST) -> list[ast.AST]:
    """Nodes that run when the module is loaded: not in functions, nor for type checkers only."""
    nodes: list[ast.AST] = []
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            continue
        if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test):
            continue
        nodes += [node, *_executed(node)]
    return nodes
