"""A sheet of paper in millimetres, and the two kinds of file that a printer takes.

Both are written from one list of marks in millimetres. A page of polygons, lines and Helvetica takes 60
lines; a library would add an imaging library to every installation. Tests read both files back. Fonts are
not embedded.
"""

from server.printing.board_sheet import board_sheet
from server.printing.marker_sheet import marker_sheet
from server.printing.paper import PAPER_MM
from server.printing.pdf import pdf_from_sheet
from server.printing.sheet import Disc, Fill, Label, Line, Sheet
from server.printing.svg import svg_from_sheet

__all__ = [
    "PAPER_MM",
    "Disc",
    "Fill",
    "Label",
    "Line",
    "Sheet",
    "board_sheet",
    "marker_sheet",
    "pdf_from_sheet",
    "svg_from_sheet",
]
