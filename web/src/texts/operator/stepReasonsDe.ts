// Begründungen der Schritte auf Deutsch. Die englischen stammen vom Server.
export const stepReasonsDe = {
  noCase: {
    message: "Es ist kein Fall geöffnet.",
    remedy: "Legen Sie einen Fall an, oder öffnen Sie einen vorhandenen.",
  },
  cameraMissing: {
    message: "Die Kamera ist nicht kalibriert.",
    remedy: "Kalibrieren Sie die Kamera: Nehmen Sie Ansichten der Tafel auf.",
  },
  cameraOfSettings: { message: "Die Kalibrierung der Kamera stammt aus den Einstellungen.", remedy: "" },
  cameraDone: { message: "Die Kamera ist kalibriert.", remedy: "" },
  cameraChecked: { message: "Die Kamera ist kalibriert, ihre Genauigkeit geprüft.", remedy: "" },
  cameraFailed: {
    message: "Die Kamera misst einen bekannten Abstand um {error} mm falsch, erlaubt {max} mm.",
    remedy: "Prüfen Sie die Genauigkeit erneut an einer ebenen Tafel, oder kalibrieren Sie neu.",
  },
  toolMissing: {
    message: "Es ist kein Instrument kalibriert.",
    remedy: "Kalibrieren Sie das Instrument: Schwenken Sie es, bis genug Lagen erfasst sind.",
  },
  axisMissing: {
    message: "Die Achse des Instruments ist unbekannt.",
    remedy: "Drehen Sie das Instrument um seine Achse.",
  },
  planMissing: {
    message: "Es gibt noch keine Planung.",
    remedy: "Planen Sie auf dem CT: Senden Sie es, und benennen Sie einen Wirbel.",
  },
  channelMissing: {
    message: "Es ist kein Kanal zum Bohren gewählt.",
    remedy: "Wählen Sie in der Planung den Kanal, der gebohrt wird.",
  },
  planDone: { message: "Ein Kanal ist zum Bohren gewählt.", remedy: "" },
  registrationMissing: {
    message: "Der Wirbel, der gebohrt werden soll, ist nicht registriert.",
    remedy: "Registrieren Sie: Tasten Sie die geplanten Landmarken an.",
  },
  registrationDone: { message: "Registriert. Verfahren: {method}.", remedy: "" },
  nothingToCheck: {
    message: "Es gibt keine gültige Registrierung, die geprüft werden könnte.",
    remedy: "Registrieren Sie: Tasten Sie die geplanten Landmarken an.",
  },
  checkMissing: {
    message: "Die Registrierung wurde noch nicht an einer Landmarke geprüft.",
    remedy: "Halten Sie die Spitze auf eine Landmarke, die nicht verwendet wurde.",
  },
  checkDone: {
    message: "Spitze auf {landmark}: {distance} mm vom geplanten Ort, erlaubt {max} mm.",
    remedy: "",
  },
  checkFailed: {
    message: "Spitze auf {landmark}: {distance} mm vom geplanten Ort, erlaubt {max} mm.",
    remedy: "Prüfen Sie erneut, korrigieren Sie die Registrierung, oder registrieren Sie neu.",
  },
  checkDue: {
    message: "Die Prüfung an {landmark} ist {minutes} min alt.",
    remedy: "Halten Sie die Spitze auf eine Landmarke, die nicht verwendet wurde.",
  },
  navigationWaits: { message: "Die Navigation wartet auf: {step}.", remedy: "" },
  navigationUnsigned: {
    message: "Die Navigation wartet auf eine Gegenzeichnung.",
    remedy: "Eine zweite Person muss gegenzeichnen.",
  },
  navigationUnconfirmed: {
    message: "Die Navigation wartet nach einem Neustart auf eine Bestätigung.",
    remedy: "Bestätigen Sie oben, oder prüfen Sie an einer Landmarke.",
  },
  navigationDone: { message: "Das Instrument wird relativ zum Kanal angezeigt.", remedy: "" },
};

export type StepReasons = typeof stepReasonsDe;
