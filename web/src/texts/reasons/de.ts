// Reasons for a missing picture, number or marker.
import type { Texts } from "../catalogue";

export const reasonsDe: Pick<Texts, "cause" | "unseen"> = {
  cause: {
    hidden: {
      state: "SEITE WAR VERDECKT",
      sentence: "Die Live-Anzeige beginnt, sobald die Seite sichtbar ist.",
    },
    connecting: { state: "VERBINDET", sentence: "Wartet auf den Server." },
    "not-reached": {
      state: "SERVER NICHT ERREICHT",
      sentence: "Prüfen, ob dieses Gerät im Netz ist und Coaxial läuft. Neuer Versuch automatisch.",
    },
    "server-gone": {
      state: "SERVER GETRENNT",
      sentence: "Der Server antwortet nicht. Neuer Versuch automatisch.",
    },
    "process-starting": {
      state: "STARTET",
      sentence:
        "Das Tracking wird gestartet. Das dauert einige Sekunden, beim ersten Start ein bis zwei Minuten.",
    },
    "process-restarting": {
      state: "STARTET NEU",
      sentence: "Das Tracking blieb stehen und wird neu gestartet.",
    },
    "process-given_up": {
      state: "TRACKING ANGEHALTEN",
      sentence: "Das Tracking ist zu oft ausgefallen. Siehe Meldung.",
    },
    "source-opening": { state: "KAMERA WIRD GEÖFFNET", sentence: "Die Kamera wird geöffnet." },
    "source-reconnecting": {
      state: "KAMERA VERLOREN",
      sentence: "Die Kamera liefert keine Bilder. Neuer Versuch automatisch.",
    },
    "source-ended": { state: "ENDE DES VIDEOS", sentence: "Das Video wurde bis zum Ende abgespielt." },
    "no-image": { state: "WARTET", sentence: "Kein Bild von der Kamera." },
    "no-picture": { state: "WARTET", sentence: "Auf dieser Seite ist noch kein Bild eingetroffen." },
    old: { state: "ZU ALT", sentence: "Die neuesten Daten sind zu alt und werden nicht gezeigt." },
  },
  unseen: {
    NO_CANDIDATE: "nichts im Bild sieht so aus",
    SCORE_TOO_LOW: "zu wenige seiner Kanten sind sichtbar",
    TARGET_SCORE_TOO_LOW: "Kanten sichtbar, die er nicht hat",
    SHAPE_DIFFERS: "ähnliches Objekt mit anderem Muster",
    NOT_REPORTED: "das Trackingsystem meldet keine gültige Lage",
    MARKER_TWICE: "zweimal im Bild: alle bis auf einen abdecken oder entfernen",
  },
};
