import type { RoomTexts } from "./en";

export const roomDe: RoomTexts = {
  watching: "Es sehen zu",
  unknown: "Wer zusieht, ist gerade nicht bekannt.",
  you: "Sie",
  role: {
    operator: "Bedienung",
    supervisor: "Aufsicht",
    viewer: "Zuschauer",
    screen: "Saalbildschirm",
    camera: "Kamera",
  },
  line: { good: "gute Leitung", slow: "langsame Leitung", silent: "antwortet nicht" },
};
