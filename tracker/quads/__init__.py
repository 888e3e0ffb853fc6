"""Quad hypotheses: squares of which one corner or two opposite sides are visible."""

from tracker.quads.hypotheses import Quads, corner_quads_of, pair_quads_of

__all__ = ["Quads", "corner_quads_of", "pair_quads_of"]
