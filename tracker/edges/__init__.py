"""Edges: gradient, edgels placed to sub-pixel, chains."""
