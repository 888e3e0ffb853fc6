export const marksEn = {
  layer:
    "The video. Move over it to point; to draw, choose a drawing tool and drag. The arrow keys move the pointer.",
  layerCut:
    "Move over the cut to point; to draw, choose a drawing tool and drag. The arrow keys move the pointer.",
  tools: "Point and draw",
  tool: { point: "Point", pen: "Pen", arrow: "Arrow", circle: "Circle" },
  undo: "Undo",
  clear: "Clear mine",
  clearAll: "Clear all",
  ago: "# s ago",
  seenBy: "Visible to everybody who is watching.",
  fades: "The pointer disappears after 2 s, a drawing # s after its image.",
  lineGone: "No connection: nobody sees what you mark.",
  noPicture: "Drawing is possible only on a live picture.",
};

export type MarksTexts = typeof marksEn;
