"""Sheet as SVG with a user unit of one millimetre."""

from xml.sax.saxutils import escape

from server.printing.sheet import Disc, Fill, Line, Mark, Sheet


def svg_from_sheet(sheet: Sheet) -> str:
    """Return the SVG text, with width and height in mm and a viewBox of the same numbers."""
    width, height = sheet.size_mm
    marks = "\n".join(f"  {_element(mark)}" for mark in sheet.marks)
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:g}mm" height="{height:g}mm" '
        f'viewBox="0 0 {width:g} {height:g}">\n'
        f"  <title>{escape(sheet.title)}</title>\n"
        f"{marks}\n</svg>\n"
    )


def _element(mark: Mark) -> str:
    if isinstance(mark, Fill):
        points = " ".join(f"{x:.4f},{y:.4f}" for x, y in mark.corners_mm)
        return f'<polygon points="{points}" fill="{_colour(mark)}"/>'
    if isinstance(mark, Disc):
        (x, y), radius = mark.centre_mm, mark.radius_mm
        return f'<circle cx="{x:.4f}" cy="{y:.4f}" r="{radius:.4f}" fill="black"/>'
    if isinstance(mark, Line):
        (x1, y1), (x2, y2) = mark.start_mm, mark.end_mm
        return (
            f'<line x1="{x1:.4f}" y1="{y1:.4f}" x2="{x2:.4f}" y2="{y2:.4f}" '
            f'stroke="black" stroke-width="{mark.width_mm:g}"/>'
        )
    x, y = mark.at_mm
    return (
        f'<text x="{x:.4f}" y="{y:.4f}" font-family="Helvetica, Arial, sans-serif" '
        f'font-size="{mark.size_mm:g}">{escape(mark.text)}</text>'
    )


def _colour(mark: Fill) -> str:
    if mark.white or mark.grey_ratio == 0.0:
        return "white" if mark.white else "black"
    level = round(255 * mark.grey_ratio)
    return f"rgb({level},{level},{level})"
