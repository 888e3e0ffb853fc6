"""Adaptive picture size per viewer, with pictures and messages made once for all viewers of a size.

sizes.py          picture sizes, and what a viewer may choose
adaptive_size.py  the size that a connection carries, by send times and skipped images
picture_cache.py  the picture of an instant in a size, encoded once and only on demand
message_cache.py  the message of an instant, serialised once; only send-time fields differ between viewers
"""
