"""A printed plate has each cross at its true place, and a PDF with several pages is complete."""

import re

from server.printing import Attachment, Label, Line, grid_of_divots, pdf_from_sheets, plate_sheet


def test_crosses_are_as_far_apart_as_the_divots() -> None:
    divots = grid_of_divots(3, 2, 60.0)
    sheet = plate_sheet(divots, name="A4")
    centres = {}
    for mark in sheet.marks:
        if isinstance(mark, Label) and mark.text in divots:
            centres[mark.text] = (mark.at_mm[0] - 1.5, mark.at_mm[1] + 1.5)
    first = centres["1"]
    for name, (x, y, _) in divots.items():
        assert abs(centres[name][0] - first[0] - x) < 1e-9
        assert abs(centres[name][1] - first[1] - y) < 1e-9
    for x, y in centres.values():
        arms = [
            mark
            for mark in sheet.marks
            if isinstance(mark, Line) and abs(mark.start_mm[0] - x) + abs(mark.start_mm[1] - y) < 0.5
        ]
        assert len(arms) == 4


def test_every_object_of_a_pdf_is_where_its_table_says() -> None:
    sheet = plate_sheet(grid_of_divots(2, 2, 60.0), name="A4")
    attachment = Attachment(name="a (b).json", content=b"{}\n")
    for count, given in ((1, None), (3, attachment)):
        pdf = pdf_from_sheets([sheet] * count, attachment=given)
        table = pdf[int(pdf.split(b"startxref\n")[1].split(b"\n")[0]) :]
        starts = [int(one) for one in re.findall(rb"(\d{10}) 00000 n", table)]
        assert [pdf[at:].split(b" ", 1)[0] for at in starts] == [b"%d" % (n + 1) for n in range(len(starts))]
        assert pdf.count(b"/Type /Page ") == count
        for referred in {int(one) for one in re.findall(rb"(\d+) 0 R", pdf)}:
            assert referred <= len(starts)
    assert b"/F (a \\(b\\).json)" in pdf
