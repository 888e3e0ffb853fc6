"""The command line: `coaxial run`, `track`, `calibrate`, `calibrate-rig`, `marker`.

Nothing heavy is imported until a command needs it, so that `coaxial --help` answers at once.
"""

from server.cli.commands import app, main

__all__ = ["app", "main"]
