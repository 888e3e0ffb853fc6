"""Paper sizes: width and height in mm, portrait orientation."""

from server.printing.sheet import Point

A4_MM: Point = (210.0, 297.0)
PAPER_MM: dict[str, Point] = {"A4": A4_MM, "A3": (297.0, 420.0), "letter": (215.9, 279.4)}
