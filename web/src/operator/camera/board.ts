// Calibration boards and their parameters.
import type { CollectionMessage } from "../../api";

export type Board = CollectionMessage["board"];
export type Pattern = Board["pattern"];

/** Default board of each kind, as printed by this program and shown in the rehearsal. */
export function boardOf(pattern: Pattern): Board {
  switch (pattern) {
    case "dots":
      return { pattern, columns: 14, rows: 10, pitch_mm: 12, layout: "symmetric", fiducials: [] };
    case "checkerboard":
      return { pattern, columns: 10, rows: 7, square_mm: 15 };
    case "charuco":
      return {
        pattern,
        columns: 11,
        rows: 8,
        square_mm: 15,
        marker_mm: 11,
        dictionary: "DICT_5X5_100",
        layout: null,
      };
    case "aprilgrid":
      return { pattern, columns: 7, rows: 5, tag_mm: 20, gap_mm: 5 };
  }
}

export const startingBoard = boardOf("dots");

/** Plausibility of a board's numbers; the server validates the rest. */
export function isBoard(board: Board): boolean {
  const counts = [board.columns, board.rows].every((n) => Number.isInteger(n) && n >= 2 && n <= 200);
  return counts && areLengths(board);
}

function areLengths(board: Board): boolean {
  switch (board.pattern) {
    case "dots":
      return isLength(board.pitch_mm);
    case "checkerboard":
      return isLength(board.square_mm);
    case "charuco":
      return isLength(board.square_mm) && isLength(board.marker_mm) && board.marker_mm < board.square_mm;
    case "aprilgrid":
      return isLength(board.tag_mm) && isLength(board.gap_mm) && board.gap_mm <= board.tag_mm;
  }
}

const isLength = (mm: number): boolean => mm > 0 && mm <= 1000;
