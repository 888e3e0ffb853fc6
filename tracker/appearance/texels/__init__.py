"""The picture between texels: what is seen at any place of the marker's plane.

Only compiled loops: `add_picture` for many places at once.
"""
