"""The steps before the theatre, each with its gate: camera, tool, plan; and what they made, in use."""

from server.procedure.steps import Steps

__all__ = ["Steps"]
