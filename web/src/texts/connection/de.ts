import type { ConnectionTexts } from "./en";

export const connectionDe: ConnectionTexts = {
  size: "Bildgröße",
  sizes: { auto: "Automatisch", full: "Voll", half: "Halb", quarter: "Viertel" },
  thin: "Langsame Leitung",
  server: "Langsamer Server",
  decoding: "Langsames Dekodieren",
  drawing: "Langsames Zeichnen",
  reduced: "Verkleinertes Bild",
  rate: "Bilder/s",
  ages: "Wie alt alles ist",
  age: { picture: "Bild", numbers: "Zahlen", scene: "3-D", clock: "Uhr des Servers, voraus um" },
};
