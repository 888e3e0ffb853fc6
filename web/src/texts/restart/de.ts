import type { RestartTexts } from "./en";

export const restartDe: RestartTexts = {
  title: "Navigation angehalten",
  because: {
    server_started:
      "Der Server wurde neu gestartet. Bis zur Bestätigung wird nichts gegen den Kanal angezeigt.",
    tracking_started:
      "Das Tracking wurde neu gestartet. Ob die Kamera inzwischen bewegt wurde, hat niemand gesehen.",
  },
  look: {
    reference: "Ist das der richtige Patient, und ist der Marker am Knochen unberührt?",
    camera: "Liegt der Kanal im Bild noch auf dem Knochen?",
  },
  confirm: "Bestätigen: weiter mit",
  others: "Das bestätigt der Bediener.",
  orCheck: "Im Zweifel an einer Landmarke prüfen.",
};
