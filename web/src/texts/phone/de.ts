import type { PhoneTexts } from "./en";

export const phoneDe: PhoneTexts = {
  title: "Dieses Gerät als Kamera",
  lead: "Befestigen Sie das Gerät unbeweglich, mit dem Marker im Bild, und lassen Sie diese Seite geöffnet. Die Bilder werden an den Server gesendet und hier nicht gespeichert.",
  preview: "Bild der Kamera dieses Geräts",
  noPreview: "Hier erscheint das Bild der Kamera.",
  start: "START",
  stop: "STOPP",
  state: {
    idle: "Sendet nicht",
    connecting: "Verbindung zum Server …",
    opening: "Warten auf die Kamera …",
    sending: "Sendet",
    lost: "Keine Verbindung: neuer Versuch automatisch",
    none: "Sendet nichts",
  },
  image: "Bild",
  imageValue: "{width} × {height} px · {size} · JPEG {quality} %",
  rate: "Gesendet",
  perSecond: "{rate} Bilder/s",
  focus: "Fokus",
  focusState: {
    locked: "gesperrt",
    automatic: "automatisch, NICHT gesperrt",
    unknown: "unbekannt, NICHT gesperrt",
  },
  focusAt: "auf {distance} m",
  times: "Bildzeiten",
  clock: {
    capture: "der Aufnahme",
    presentation: "der Anzeige; die Aufnahme war früher, um eine unbekannte Zeit",
  },
  server: "Server",
  serverValue: "Kamera {state} · {rate} Bilder/s",
  delay: "Übertragungszeit",
  delayValue: "{min} bis {max} ms",
  screenOff:
    "Dieser Browser kann den Bildschirm nicht eingeschaltet lassen: Schalten Sie die automatische Sperre aus.",
  noCamera: {
    insecure: {
      title: "Diese Seite wurde nicht über https geöffnet",
      sentence:
        "Browser geben die Kamera nur für https frei. Öffnen Sie die Adresse, die mit https beginnt, oder localhost auf dem Rechner des Servers. Ein Server, der für andere erreichbar ist, verwendet automatisch https.",
    },
    denied: {
      title: "Diese Seite darf die Kamera nicht benutzen",
      sentence:
        "Erlauben Sie die Kamera für diese Adresse in den Einstellungen des Browsers, laden Sie die Seite neu und tippen Sie auf START.",
    },
    none: {
      title: "Dieses Gerät hat keine brauchbare Kamera",
      sentence: "Schließen Sie eine an, oder verwenden Sie ein anderes Gerät.",
    },
    busy: {
      title: "Die Kamera wird bereits verwendet oder wurde getrennt",
      sentence: "Schließen Sie das andere Programm, das sie benutzt, und tippen Sie auf START.",
    },
    old: {
      title: "Dieser Browser kann keine Kamera senden",
      sentence: "Er ist zu alt. Verwenden Sie Chrome, Edge, Firefox oder Safari ab 2024.",
    },
    other: {
      title: "Die Kamera ließ sich nicht öffnen",
      sentence: "Laden Sie diese Seite neu und tippen Sie wieder auf START.",
    },
  },
  limits: "Einschränkungen von Telefonkameras",
  limitList: {
    focus:
      "Der Fokus lässt sich nicht auf jedem Gerät sperren, auf iPhones und iPads nie. Ändert sich der Fokus, ist die Kalibrierung ungültig.",
    lens: "Telefone mit mehreren Objektiven können im Nahbereich oder bei wenig Licht automatisch wechseln. Wählen Sie einen Abstand, bei dem das nicht geschieht.",
    shutter:
      "Die meisten Telefone lesen den Sensor zeilenweise aus und geben die Auslesezeit nicht an: Bewegte Objekte werden falsch gemessen.",
    steady: "Ein Bildstabilisator verschiebt das Bild. Schalten Sie ihn aus, wo das Gerät es erlaubt.",
    other: "Ein anderes Telefon oder Objektiv wird nicht erkannt: Kalibrieren Sie nach einem Wechsel neu.",
    turn: "Zwischen Hoch- und Querformat ändert sich die Bildgröße: Die Kalibrierung gilt dann nicht.",
  },
  dashboard: "Zur Übersicht",
};
