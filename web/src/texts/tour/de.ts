import type { TourTexts } from "./en";

export const tourDe: TourTexts = {
  title: "Rundgang",
  again: "Rundgang von drei Minuten durch den Probebetrieb",
  count: "{at} von {all}",
  escape: "Esc beendet",
  back: "Zurück",
  next: "Weiter",
  end: "Rundgang beenden",
  leave: "Verlassen",
  offer: {
    title: "Neu hier?",
    sentence:
      "Ein Rundgang von drei Minuten zeigt, wozu jede Seite dient. Er ändert nichts, und Sie können ihn jederzeit verlassen.",
    start: "Rundgang beginnen",
    later: "Jetzt nicht",
  },
  stations: {
    video: {
      title: "Das Video",
      sentence:
        "Die Kamera sieht den quadratischen Marker am Bohrer. Der geplante Kanal ist blau ins Video gezeichnet, die Linie des Bohrers orange. Ist das Video verspätet oder fehlt es, wird es verdeckt und der Grund genannt.",
    },
    alarms: {
      title: "Die Alarme",
      sentence:
        "Diese Leiste zeigt den dringendsten Alarm mit Namen, Farbe und Anzahl der Zeichen, im OP auch mit Ton. Auf diesen Seiten bleibt sie sichtbar, und nichts verdeckt sie.",
    },
    steps: {
      title: "Die Schritte",
      sentence:
        "Ein Eingriff geht von oben nach unten: ✓ ist erledigt, ○ offen. Ein Ausrufezeichen heißt veraltet: Eine neue Planung beendet zum Beispiel die Registrierung mit der alten.",
    },
    camera: {
      title: "Kamera",
      sentence:
        "Bewegen Sie eine gedruckte Tafel vor der Kamera: Ansichten werden automatisch aufgenommen. Der Fehler in Pixeln und seine Grenze entscheiden, ob die Kalibrierung gespeichert wird.",
    },
    tool: {
      title: "Instrument",
      sentence:
        "Schwenken Sie den Bohrer um seine ruhende Spitze, dann drehen Sie ihn: Das ergibt Spitze und Achse relativ zum Marker. Ein Zertifikat nennt die Genauigkeit von Kamera und Instrument zusammen.",
    },
    plan: {
      title: "Planung",
      sentence:
        "Im CT: der Wirbel, ein Kanal und eine Schraube für jede Seite und die Landmarken, die später berührt werden. Der Probebetrieb hat ein eigenes CT.",
    },
    register: {
      title: "Registrierung",
      sentence:
        "Sie bringt Planung und Patient zusammen, zum Beispiel durch Berühren von Landmarken mit der Spitze. Der erwartete Fehler am Eintrittspunkt wird genannt und über seiner Grenze abgelehnt.",
    },
    check: {
      title: "Prüfung",
      sentence:
        "Berühren Sie eine Landmarke, die nicht für die Registrierung verwendet wurde. Vor einer bestandenen Prüfung werden keine Werte gezeigt, und sie wird nach einiger Zeit wieder fällig.",
    },
    figures: {
      title: "Vier Werte mit ihren Grenzen",
      sentence:
        "Eintritt, Winkel, Tiefe und Wand: Weiß ist innerhalb der Grenze, gelb darüber, rot durch die Wand oder über das Ende hinaus. Wäre ein Wert alt oder unzuverlässig, steht dort stattdessen der Grund.",
    },
    theatre: {
      title: "Der Bildschirm im OP",
      sentence:
        "Dasselbe Video und dieselben Werte, aus 3 m lesbar, mit dem CT unter dem Bohrer. Eine Berührung oder ein Fußschalter ändert die Aufteilung. Der Ton muss einmal durch Berühren eingeschaltet werden.",
    },
    supervisor: {
      title: "Die Seite der Aufsicht",
      sentence:
        "Eine zweite Person sieht von überall dasselbe, zeigt und zeichnet im Video, unterschreibt mit und bittet um Halt. Diese Seite ändert nichts am Eingriff.",
    },
    report: {
      title: "Der Bericht",
      sentence:
        "Alle Schritte mit Werten, Grenzen und Namen zum Drucken. Um einen Schritt selbst zu versuchen, spielen Sie seine Szene auf der Seite Fall unter Probebetrieb; ? auf jeder Seite öffnet das Handbuch.",
    },
  },
};
