import type { MarksTexts } from "./en";

export const marksDe: MarksTexts = {
  layer:
    "Das Video. Zum Zeigen darüberfahren; mit gewähltem Werkzeug drücken und zeichnen. Pfeiltasten bewegen den Zeiger.",
  tools: "Zeigen und zeichnen",
  tool: { point: "Zeigen", pen: "Stift", arrow: "Pfeil", circle: "Kreis" },
  undo: "Rückgängig",
  clear: "Meine löschen",
  clearAll: "Alle löschen",
  ago: "vor # s",
  seenBy: "Alle, die zusehen, sehen es.",
  fades:
    "Ein Zeiger verschwindet 2 s nach seiner letzten Bewegung, eine Zeichnung # s nach dem Bild, auf dem sie entstand.",
  lineGone: "Die Leitung ist weg: Niemand sieht, was Sie zeigen.",
  noPicture: "Es gibt kein Live-Bild, auf dem man zeichnen könnte.",
};
