import type { PhoneTexts } from "./en";

export const phoneDe: PhoneTexts = {
  title: "Dieses Gerät als Kamera",
  lead: "Befestigen Sie es so, dass nichts es bewegt, mit dem Marker im Bild, und lassen Sie diese Seite vorn. Die Bilder gehen zum Server; hier bleibt keines.",
  preview: "Was die Kamera dieses Geräts sieht",
  noPreview: "Hier erscheint das Bild der Kamera.",
  start: "START",
  stop: "STOPP",
  state: {
    idle: "Sendet nicht",
    connecting: "Verbindung zum Server …",
    opening: "Warten auf die Kamera …",
    sending: "Sendet",
    lost: "Keine Verbindung: wird von selbst wieder versucht",
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
    presentation: "der Anzeige: aufgenommen wurde früher, um eine unbekannte Zeit",
  },
  server: "Server",
  serverValue: "Kamera {state} · {rate} Bilder/s",
  delay: "Kommt an nach",
  delayValue: "{min} bis {max} ms",
  screenOff: "Dieser Browser hält den Bildschirm nicht an: Schalten Sie die automatische Sperre aus.",
  noCamera: {
    insecure: {
      title: "Diese Seite wurde nicht über https geöffnet",
      sentence:
        "Browser verbergen die Kamera vor solchen Seiten. Öffnen Sie die Adresse, die mit https beginnt, oder localhost auf dem Rechner des Servers selbst. Ein Server, den andere erreichen, spricht von selbst https.",
    },
    denied: {
      title: "Diese Seite darf die Kamera nicht benutzen",
      sentence:
        "Erlauben Sie die Kamera für diese Adresse in den Einstellungen des Browsers, laden Sie die Seite neu und tippen Sie auf START.",
    },
    none: {
      title: "Dieses Gerät hat keine brauchbare Kamera",
      sentence: "Schließen Sie eine an, oder nehmen Sie ein anderes Gerät.",
    },
    busy: {
      title: "Die Kamera ist in Gebrauch oder wurde entzogen",
      sentence: "Schließen Sie das andere Programm, das sie benutzt, und tippen Sie auf START.",
    },
    old: {
      title: "Dieser Browser kann keine Kamera senden",
      sentence: "Er ist zu alt. Nehmen Sie Chrome, Edge, Firefox oder Safari ab 2024.",
    },
    other: {
      title: "Die Kamera ließ sich nicht öffnen",
      sentence: "Laden Sie diese Seite neu und tippen Sie wieder auf START.",
    },
  },
  limits: "Was die Kamera eines Telefons nicht kann",
  limitList: {
    focus:
      "Nicht jedes Gerät lässt seinen Fokus sperren; iPhones und iPads nicht. Ein Fokus, der sich bewegt, macht die Kalibrierung ungültig.",
    lens: "Ein Telefon mit mehreren Objektiven wechselt womöglich von selbst, nah oder im Dunkeln. Wählen Sie einen Abstand, in dem es das nicht tut.",
    shutter:
      "Die meisten Telefone lesen ihren Sensor zeilenweise und sagen nicht, wie schnell: Was sich bewegt, wird falsch gemessen.",
    steady: "Ein Bildstabilisator verschiebt das Bild. Schalten Sie ihn aus, wo das Gerät es erlaubt.",
    other:
      "Ein anderes Telefon oder Objektiv wird vom kalibrierten nicht unterschieden: Kalibrieren Sie neu.",
    turn: "Von hochkant nach quer gedreht haben die Bilder eine andere Größe, und die Kalibrierung passt nicht.",
  },
  dashboard: "Zur Übersicht",
};
