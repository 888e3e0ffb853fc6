"""The command line: what can be typed after `coaxial`, a file or room for each group of commands.

Nothing heavy is imported until a command needs it, so that `coaxial --help` answers at once.
"""

from server.cli.commands import app, main

__all__ = ["app", "main"]
