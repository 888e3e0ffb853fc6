"""The steps of the procedure, each with its acceptance limits: camera, tool, plan, registration, check."""

from server.procedure.setup_publisher import TrackingLink
from server.procedure.steps import Steps

__all__ = ["Steps", "TrackingLink"]
