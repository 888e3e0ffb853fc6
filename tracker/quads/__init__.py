"""Quad hypotheses: squares of which one corner is visible."""

from tracker.quads.hypotheses import Quads, corner_quads_of

__all__ = ["Quads", "corner_quads_of"]
