import type { ConnectionTexts } from "./en";

export const connectionDe: ConnectionTexts = {
  size: "Bildgröße",
  sizes: { auto: "Automatisch", full: "Voll", half: "Halb", quarter: "Viertel" },
  thin: "Langsame Verbindung",
  server: "Langsamer Server",
  decoding: "Langsames Dekodieren",
  drawing: "Langsames Zeichnen",
  reduced: "Verkleinertes Bild",
  rate: { one: "{count} Bild/s", other: "{count} Bilder/s" },
  ages: "Alter der Anzeige",
  age: { picture: "Bild", numbers: "Werte", scene: "3-D", clock: "Serveruhr geht vor um" },
};
