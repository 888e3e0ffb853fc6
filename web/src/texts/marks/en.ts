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
  seenBy:
    "Visible to everybody who is watching; a mark on a cut in every cut within 2 mm and in 3-D. A click on the bone in 3-D marks a point.",
  fades: "The pointer disappears 2 s after its last movement, a drawing # s after its image.",
  lineGone: "No connection: nobody sees what you mark.",
  noPicture: "Drawing is possible only on a live picture.",
};

export type MarksTexts = typeof marksEn;
