import type { CertificateTexts } from "./en";

export const certificateDe: CertificateTexts = {
  title: "Genauigkeitszertifikat",
  lead: "Gibt an, wie weit eine Spitze mit dieser Kamera, diesem Instrument und dieser Version von der Wahrheit abweichen kann. Es kommt aus einem Test auf einer Platte mit Mulden: „coaxial certify“ im Handbuch.",
  accuracy: "Genauigkeit",
  certified: "zertifiziert bis {day} auf {mm} mm",
  notCertified: "nicht zertifiziert",
  ofTool: "{tool}: {state}",
  noPicture: "Warten auf das erste Bild.",
  install: "Zertifikat installieren",
  issued: "Ausgestellt {day} von {person}",
  issuedOnly: "Ausgestellt {day}",
  pdf: "Zertifikat als PDF",
  json: "Zertifikat als JSON",
  guide: "Die Genauigkeit testen",
};
