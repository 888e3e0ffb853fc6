import type { MarksTexts } from "./en";

export const marksDe: MarksTexts = {
  layer:
    "Das Video. Zum Zeigen darüberfahren, zum Zeichnen ein Werkzeug wählen und ziehen. Die Pfeiltasten bewegen den Zeiger.",
  layerCut:
    "Zum Zeigen über den Schnitt fahren, zum Zeichnen ein Werkzeug wählen und ziehen. Die Pfeiltasten bewegen den Zeiger.",
  tools: "Zeigen und zeichnen",
  tool: { point: "Zeigen", pen: "Stift", arrow: "Pfeil", circle: "Kreis" },
  undo: "Rück\u00adgängig",
  clear: "Meine löschen",
  clearAll: "Alle löschen",
  ago: "vor # s",
  seenBy: "Für alle sichtbar, die zusehen.",
  fades: "Der Zeiger verschwindet nach 2 s, eine Zeichnung # s nach ihrem Bild.",
  lineGone: "Keine Verbindung: Niemand sieht, was Sie zeigen.",
  noPicture: "Zeichnen ist nur auf einem Live-Bild möglich.",
};
