import type { RoomTexts } from "./en";

export const roomDe: RoomTexts = {
  watching: "Zuschauer",
  unknown: "Wer zusieht, ist zurzeit nicht bekannt.",
  thisComputer: "dieser Computer",
  you: "Sie",
  role: {
    operator: "Bedienung",
    supervisor: "Aufsicht",
    viewer: "Betrachter",
    screen: "OP-Bildschirm",
    camera: "Kamera",
  },
  what: "Wer sieht was",
  freshness: { old: "Bild zu alt", hidden: "Seite im Hintergrund", unknown: "ob live, unbekannt" },
  figures: "Nur Zahlen",
  upTo: "bis # ms alt",
  line: { good: "gute Verbindung", slow: "langsame Verbindung", silent: "antwortet nicht" },
};
