"""Tables 1 and 2 of the paper: what its equations give from the printed coordinates, and what differs.

In cm and px. A cell follows if the value of the formula, rounded to the printed digits, is the printed one.
"""

from collections.abc import Callable, Mapping

import numpy as np
import pytest

from tracker.camera.ruler import Ruler, angle_deg, axial_distance_mm, distances, pixels_per_mm

MM_PER_CM = 10.0
Row = dict[str, float]

TABLE_1_COLUMNS = ("D", "V", "H", "theta", "Rd", "u1", "v1", "u2", "v2", "Pd", "Pd/Rd")
TABLE_1 = (
    (86.0, 59.0, 62.6, 43.3, 2.0, 325.0, 224.0, 335.0, 209.0, 18.0, 9.2),
    (104.3, 59.0, 86.0, 34.5, 2.0, 353.0, 225.0, 361.0, 214.0, 13.6, 6.9),
    (125.5, 59.0, 110.8, 28.0, 1.9, 355.0, 137.0, 363.0, 128.0, 12.0, 6.3),
    (150.1, 59.0, 138.0, 23.1, 1.9, 349.0, 48.0, 354.0, 38.0, 11.2, 5.8),
)
TABLE_2_COLUMNS = ("x1", "y1", "x2", "y2", "Rd", "u1", "v1", "u2", "v2", "Pd", "Pd/Rd", "f", "Rd calculated")
TABLE_2 = (
    (16.4, 10.6, 15.0, 9.4, 1.9, 422.0, 429.0, 406.0, 441.0, 20.0, 10.8, 1028.2, 1.85),
    (15.0, 11.9, 14.0, 10.2, 1.9, 405.0, 416.0, 393.0, 433.0, 20.8, 10.8, 1025.4, 1.93),
    (12.0, 13.0, 11.9, 11.8, 1.2, 368.0, 406.0, 372.0, 418.0, 12.6, 10.9, 1034.2, 1.16),
    (7.7, 11.8, 9.0, 10.4, 1.9, 311.0, 424.0, 327.0, 437.0, 20.6, 10.8, 1024.9, 1.92),
    (6.8, 10.8, 8.4, 9.7, 1.9, 300.0, 435.0, 318.0, 445.0, 20.6, 10.8, 1024.0, 1.91),
)
V_CM, H_CM, D_CM, F_PX = 56.0, 77.0, 95.2, 1028.2

# (row from 1, column): what follows in place of what is printed. Table 1 gives no world coordinates, so its
# ratio is that of the printed Rd; the three would follow from an Rd that was rounded after it was used.
NOT_FOLLOWING_1 = {(1, "Pd/Rd"): 9.0, (2, "Pd/Rd"): 6.8, (4, "Pd/Rd"): 5.9}
NOT_FOLLOWING_2 = {
    (1, "Rd"): 1.8,
    (2, "Rd"): 2.0,
    (2, "Pd/Rd"): 10.6,
    (3, "Pd/Rd"): 10.5,
    (5, "Pd/Rd"): 10.6,
    (1, "f"): 1032.7,
    (2, "f"): 1004.5,
    (3, "f"): 1000.1,
    (4, "f"): 1027.4,
    (5, "f"): 1009.7,
    (3, "Rd calculated"): 1.17,
    (4, "Rd calculated"): 1.91,
}


def rows(columns: tuple[str, ...], table: tuple[tuple[float, ...], ...]) -> list[Row]:
    return [dict(zip(columns, row, strict=True)) for row in table]


def pixels(row: Row) -> float:
    return float(distances([row["u1"], row["v1"]], [row["u2"], row["v2"]]))


def moved_mm(row: Row) -> float:
    return MM_PER_CM * float(distances([row["x1"], row["y1"]], [row["x2"], row["y2"]]))


def follows_1(row: Row) -> Row:
    v_mm, h_mm = MM_PER_CM * row["V"], MM_PER_CM * row["H"]
    return {
        "D": axial_distance_mm(v_mm, h_mm) / MM_PER_CM,
        "theta": angle_deg(v_mm, h_mm),
        "Pd": pixels(row),
        "Pd/Rd": pixels_per_mm(pixels(row), MM_PER_CM * row["Rd"]) * MM_PER_CM,
    }


def paper_ruler(focal_length_px: float = F_PX) -> Ruler:
    return Ruler(vertical_mm=560.0, horizontal_mm=770.0, focal_length_px=focal_length_px)


def follows_2(row: Row) -> Row:
    ratio = pixels_per_mm(pixels(row), moved_mm(row))
    own = Ruler.from_displacement(vertical_mm=560.0, horizontal_mm=770.0, pixels_per_mm=ratio)
    return {
        "Rd": moved_mm(row) / MM_PER_CM,
        "Pd": pixels(row),
        "Pd/Rd": ratio * MM_PER_CM,
        "f": own.focal_length_px,
        "Rd calculated": float(paper_ruler().displacement_mm(pixels(row))) / MM_PER_CM,
    }


def not_following(
    printed: list[Row], follows: Callable[[Row], Row], digits: Mapping[str, int]
) -> dict[tuple[int, str], float]:
    found = {}
    for number, row in enumerate(printed, start=1):
        for column, value in follows(row).items():
            rounded = round(value, digits.get(column, 1))
            if rounded != row[column]:
                found[number, column] = rounded
    return found


def test_the_cells_of_table_1_that_do_not_follow_are_these() -> None:
    assert not_following(rows(TABLE_1_COLUMNS, TABLE_1), follows_1, {}) == NOT_FOLLOWING_1


def test_the_cells_of_table_2_that_do_not_follow_are_these() -> None:
    printed = rows(TABLE_2_COLUMNS, TABLE_2)
    assert not_following(printed, follows_2, {"Rd calculated": 2}) == NOT_FOLLOWING_2


def test_an_rd_rounded_after_use_would_explain_each_ratio_of_table_1() -> None:
    for row in rows(TABLE_1_COLUMNS, TABLE_1):
        low, high = (pixels(row) / (row["Rd"] + half) for half in (0.05, -0.05))
        assert low - 0.05 <= row["Pd/Rd"] <= high + 0.05


def test_in_table_2_distance_and_first_focal_length_are_as_captioned() -> None:
    assert round(paper_ruler().axial_distance_mm / MM_PER_CM, 1) == D_CM
    # The first row's f is the rounded ratio times the rounded distance, not what its coordinates give.
    assert pytest.approx(F_PX, abs=0.05) == 10.8 * D_CM


def test_calculated_rd_of_table_2_was_made_with_each_row_s_own_f_and_so_checks_nothing() -> None:
    printed = rows(TABLE_2_COLUMNS, TABLE_2)
    again = [float(paper_ruler(row["f"]).displacement_mm(pixels(row))) / MM_PER_CM for row in printed]
    assert [round(value, 2) for value in again] == [row["Rd calculated"] for row in printed]


def test_the_errors_of_table_2_from_its_coordinates_with_one_f() -> None:
    printed = rows(TABLE_2_COLUMNS, TABLE_2)
    measured = paper_ruler().displacement_mm([pixels(row) for row in printed])
    errors_mm = measured - np.array([moved_mm(row) for row in printed])
    assert errors_mm == pytest.approx([0.08, -0.45, -0.33, -0.02, -0.35], abs=0.005)
    # The paper's own claim, +-0.5 mm, holds.
    assert np.abs(errors_mm).max() < 0.5


def test_table_1_has_no_single_focal_length() -> None:
    """Its camera was refocused, or moved off its axis, between the rows: 709 to 883 px."""
    found = [
        pixels(row) / row["Rd"] * axial_distance_mm(row["V"], row["H"])
        for row in rows(TABLE_1_COLUMNS, TABLE_1)
    ]
    assert found == pytest.approx([775.4, 709.3, 795.6, 883.1], abs=0.1)
