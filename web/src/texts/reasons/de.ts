// Why there is no picture, no number, no marker.
import type { Texts } from "../catalogue";

export const reasonsDe: Pick<Texts, "cause" | "unseen"> = {
  cause: {
    hidden: {
      state: "SEITE WAR VERDECKT",
      sentence: "Sobald sie sichtbar ist, zeigt sie wieder, was live ist.",
    },
    connecting: { state: "VERBINDET", sentence: "Wartet auf den Server." },
    "not-reached": {
      state: "SERVER NICHT ERREICHT",
      sentence: "Prüfen, ob dieses Gerät im Netz ist und Coaxial läuft. Neuer Versuch von selbst.",
    },
    "server-gone": { state: "SERVER WEG", sentence: "Keine Antwort vom Server. Neuer Versuch von selbst." },
    "process-starting": {
      state: "STARTET",
      sentence: "Das Tracking wird gestartet. Das dauert einige Sekunden.",
    },
    "process-restarting": {
      state: "STARTET NEU",
      sentence: "Das Tracking blieb stehen und wird neu gestartet.",
    },
    "process-given_up": {
      state: "VERFOLGUNG STEHT",
      sentence: "Das Tracking ist zu oft ausgefallen. Siehe Meldung.",
    },
    "source-opening": { state: "KAMERA WIRD GEÖFFNET", sentence: "Die Kamera wird geöffnet." },
    "source-reconnecting": {
      state: "KAMERA VERLOREN",
      sentence: "Es kommen keine Bilder. Neuer Versuch von selbst.",
    },
    "source-ended": { state: "ENDE DES VIDEOS", sentence: "Das Video ist bis zum Ende gespielt." },
    "no-image": { state: "WARTET", sentence: "Kein Bild von der Kamera." },
    "no-picture": { state: "WARTET", sentence: "Auf dieser Seite ist noch kein Bild angekommen." },
    old: { state: "ZU ALT", sentence: "Die neuesten Daten sind zu alt und werden nicht gezeigt." },
  },
  unseen: {
    NO_CANDIDATE: "nichts im Bild sieht ihm ähnlich",
    SCORE_TOO_LOW: "zu wenige seiner Kanten sind da",
    TARGET_SCORE_TOO_LOW: "Kanten, die er nicht hat",
    SHAPE_DIFFERS: "innen eine andere Form: ein Doppelgänger",
    MARKER_TWICE: "ein zweiter Ausdruck davon ist im Bild: alle bis auf einen abdecken oder entfernen",
  },
};
