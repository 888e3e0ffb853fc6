import type { RestartTexts } from "./en";

export const restartDe: RestartTexts = {
  title: "Navigation angehalten",
  because: {
    server_started:
      "Der Server wurde neu gestartet. Bis zur Bestätigung werden keine Werte zum Kanal angezeigt.",
    tracking_started:
      "Das Tracking wurde neu gestartet. Eine Bewegung der Kamera in dieser Zeit wurde nicht erkannt.",
  },
  look: {
    reference: "Ist es derselbe Patient, und sitzt der Marker unverändert am Knochen?",
    camera: "Liegt der Kanal im Bild noch auf dem Knochen?",
  },
  confirm: "Bestätigen und fortfahren mit",
  others: "Die Bedienung muss dies bestätigen.",
  orCheck: "Im Zweifel an einer Landmarke prüfen.",
};
