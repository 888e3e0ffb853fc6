import type { OperatorTexts } from "./en";

export const operatorDe: OperatorTexts = {
  steps: "Schritte des Eingriffs",
  skip: "Zum Schritt springen",
  next: "Nächster Schritt",
  at: "{at} von {all}",
  now: "jetzt",
  locked: "später",
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
  ofRehearsal: "Probebetrieb",
  fewLandmarks: {
    one: "Die Planung hat {count} Landmarke. Die Registrierung mit Landmarken braucht mindestens {min}, mit drei Nadeln keine.",
    other:
      "Die Planung hat {count} Landmarken. Die Registrierung mit Landmarken braucht mindestens {min}, mit drei Nadeln keine.",
  },
  state: {
    missing: "offen",
    out_of_date: "veraltet",
    failed: "nicht bestanden",
    due: "wieder fällig",
    done: "erledigt",
  },
};
