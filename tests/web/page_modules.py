"""Runs modules of the page in Node, so that Python can compare what they compute."""

import json
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path

CHECKOUT = Path(__file__).resolve().parents[2]
# The machine's Node, or the one in the packages.
NODE = ["sh", ".make/with-node", "web", "node"]
# Writes the modules without types, and gives the program `load`, `given`, `fs` and `folder`.
PRELUDE = """
const fs = require("node:fs");
const path = require("node:path");
const web = process.argv[1];
const ts = require(web + "/node_modules/typescript");
const { folder, modules, given } = JSON.parse(fs.readFileSync(0, "utf8"));
for (const name of modules) {
    const source = fs.readFileSync(`${web}/src/${name}.ts`, "utf8");
    const compilerOptions = { target: "es2023", module: "commonjs" };
    const { outputText } = ts.transpileModule(source, { compilerOptions });
    const file = `${folder}/js/${name}.js`;
    fs.mkdirSync(path.dirname(file), { recursive: true });
    fs.writeFileSync(file, outputText);
}
const load = (name) => require(`${folder}/js/${name}.js`);
"""


def run_in_node(program: str, modules: Sequence[str], given: Mapping[str, object], folder: Path) -> str:
    """Run a program on modules of `web/src` and return its standard output.

    Args:
        program: JavaScript, with `load(name)` for the modules, `given`, `fs` and `folder`.
        modules: paths without extension, with all modules that they import other than as types.
        given: arguments of the program.
        folder: for the compiled modules, and for the program's own files.
    """
    arguments = {"folder": str(folder), "modules": modules, "given": given}
    finished = subprocess.run(
        [*NODE, "-e", PRELUDE + program, str(CHECKOUT / "web")],
        cwd=CHECKOUT,
        input=json.dumps(arguments),
        text=True,
        check=True,
        stdout=subprocess.PIPE,
    )
    return finished.stdout
