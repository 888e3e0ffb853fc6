"""Printable sheets in millimetres, as PDF and SVG.

Both formats are written from one list of marks. The PDF writer needs 60 lines for polygons, lines and
Helvetica; a library would add an imaging dependency to every installation. Fonts are not embedded.
"""

from server.printing.board_sheet import board_sheet
from server.printing.marker_sheet import marker_sheet
from server.printing.paper import PAPER_MM
from server.printing.pdf import Attachment, pdf_from_sheet, pdf_from_sheets
from server.printing.plate_sheet import grid_of_divots, plate_sheet
from server.printing.sheet import Disc, Fill, Label, Line, Sheet
from server.printing.svg import svg_from_sheet

__all__ = [
    "PAPER_MM",
    "Attachment",
    "Disc",
    "Fill",
    "Label",
    "Line",
    "Sheet",
    "board_sheet",
    "grid_of_divots",
    "marker_sheet",
    "pdf_from_sheet",
    "pdf_from_sheets",
    "plate_sheet",
    "svg_from_sheet",
]
