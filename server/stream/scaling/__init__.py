"""Adaptive picture size per viewer, with pictures and messages encoded once for all viewers of a size.

sizes.py          picture sizes, and the choices of a viewer
adaptive_size.py  selection of the size for a connection by send times and skipped images
picture_cache.py  the picture of an instant in a size, encoded once and only on demand
message_cache.py  the message of an instant: its content serialised once, its envelope for each viewer
"""
