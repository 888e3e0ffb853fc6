import type { RoomTexts } from "./en";

export const roomDe: RoomTexts = {
  watching: "Zuschauer",
  unknown: "Wer zusieht, ist zurzeit nicht bekannt.",
  you: "Sie",
  role: {
    operator: "Bedienung",
    supervisor: "Aufsicht",
    viewer: "Betrachter",
    screen: "OP-Bildschirm",
    camera: "Kamera",
  },
  line: { good: "gute Verbindung", slow: "langsame Verbindung", silent: "antwortet nicht" },
};
