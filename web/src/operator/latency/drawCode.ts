// Draws a code: cells inside a black border with a white margin.

const BORDER_CELLS = 1;
/** Margin that separates the border from a dark page. */
const WHITE_CELLS = 1;

/** Draws a pattern ("1" is a white cell, row by row) over the whole canvas. */
export function drawCode(canvas: HTMLCanvasElement, pattern: string, cells: number): void {
  const sidePx = Math.round(Math.min(canvas.clientWidth, canvas.clientHeight) * devicePixelRatio);
  const all = cells + 2 * (BORDER_CELLS + WHITE_CELLS);
  // Whole pixels per cell: blurred edges are detected later.
  const cellPx = Math.max(1, Math.floor(sidePx / all));
  if (canvas.width !== cellPx * all) canvas.width = canvas.height = cellPx * all;
  const context = canvas.getContext("2d", { alpha: false });
  if (context === null) return;
  const fill = (colour: string, from: number, count: number, row = from, rows = count): void => {
    context.fillStyle = colour;
    context.fillRect(from * cellPx, row * cellPx, count * cellPx, rows * cellPx);
  };
  fill("#fff", 0, all);
  fill("#000", WHITE_CELLS, cells + 2 * BORDER_CELLS);
  const first = WHITE_CELLS + BORDER_CELLS;
  for (let place = 0; place < pattern.length; place += 1) {
    if (pattern[place] === "1")
      fill("#fff", first + (place % cells), 1, first + Math.floor(place / cells), 1);
  }
}
