"""The command line: one module or package for each group of commands of `coaxial`.

Large packages are imported only by the command that needs them, so that `coaxial --help` is fast.
"""

from server.cli.commands import app, main

__all__ = ["app", "main"]
