"""Outlines: where a dark square could be of which a corner is seen, or two sides that face each other."""

from tracker.outlines.corners import Quads, corner_quads_of, pair_quads_of

__all__ = ["Quads", "corner_quads_of", "pair_quads_of"]
