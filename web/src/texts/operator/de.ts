import type { OperatorTexts } from "./en";

export const operatorDe: OperatorTexts = {
  steps: "Schritte des Eingriffs",
  skip: "Zum Schritt springen",
  next: "Nächster Schritt",
  now: "als Nächstes",
  locked: "noch nicht",
  page: {
    case: "Fall",
    camera: "Kamera",
    tool: "Instrument",
    plan: "Planung",
    register: "Registrierung",
    check: "Prüfung",
    navigate: "Navigation",
    recordings: "Aufnahmen",
    report: "Bericht",
    people: "Personen",
  },
  ready: "bereit",
  fewLandmarks:
    "Sie hat {there} Landmarken; zum Registrieren mit Punkten braucht es mindestens {min}, mit drei Nadeln keine.",
  state: {
    missing: "offen",
    out_of_date: "veraltet",
    failed: "nicht bestanden",
    due: "wieder fällig",
    done: "erledigt",
  },
};
