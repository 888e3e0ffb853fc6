export const marksEn = {
  layer: "The video. Move over it to point; with a tool chosen, press and draw. Arrow keys move the pointer.",
  tools: "Point and draw",
  tool: { point: "Point", pen: "Pen", arrow: "Arrow", circle: "Circle" },
  undo: "Undo",
  clear: "Clear mine",
  clearAll: "Clear all",
  ago: "# s ago",
  seenBy: "Everybody who watches sees it.",
  fades: "A pointer goes 2 s after it moved last, a drawing # s after the image that it was made on.",
  lineGone: "The line is gone: nobody sees what you mark.",
  noPicture: "There is no live picture to mark on.",
};

export type MarksTexts = typeof marksEn;
