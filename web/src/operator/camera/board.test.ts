import { expect, test } from "vitest";
import { boardOf, isBoard, type Board } from "./board";

test.each(["dots", "checkerboard", "charuco", "aprilgrid"] as const)(
  "the usual board of %s is one",
  (pattern) => {
    expect(boardOf(pattern).pattern).toBe(pattern);
    expect(isBoard(boardOf(pattern))).toBe(true);
  },
);

const CHECKERS = boardOf("checkerboard") as Extract<Board, { pattern: "checkerboard" }>;
const APRILGRID = boardOf("aprilgrid") as Extract<Board, { pattern: "aprilgrid" }>;
const CHARUCO = boardOf("charuco") as Extract<Board, { pattern: "charuco" }>;

test.each<[string, Board]>([
  ["one column", { ...CHECKERS, columns: 1 }],
  ["half a row", { ...CHECKERS, rows: 6.5 }],
  ["squares without size", { ...CHECKERS, square_mm: 0 }],
  ["squares that nobody has typed", { ...CHECKERS, square_mm: Number.NaN }],
  ["markers as large as their squares", { ...CHARUCO, marker_mm: 15 }],
  ["tags farther apart than they are wide", { ...APRILGRID, gap_mm: 20.5 }],
  ["tags that touch", { ...APRILGRID, gap_mm: 0 }],
])("%s is no board", (_, board) => {
  expect(isBoard(board)).toBe(false);
});
