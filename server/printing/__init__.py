"""A sheet of paper in millimetres, and the two kinds of file that a printer takes."""

from server.printing.marker_sheet import marker_sheet
from server.printing.pdf import pdf_from_sheet
from server.printing.sheet import Fill, Label, Line, Sheet
from server.printing.svg import svg_from_sheet

__all__ = ["Fill", "Label", "Line", "Sheet", "marker_sheet", "pdf_from_sheet", "svg_from_sheet"]
