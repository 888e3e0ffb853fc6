export const certificateEn = {
  title: "Accuracy certificate",
  lead: "States how far a tip may be from the truth with this camera, tool and version. It comes from a test on a plate with divots: “coaxial certify” in the guide.",
  accuracy: "Accuracy",
  certified: "certified until {day} to {mm} mm",
  notCertified: "not certified",
  ofTool: "{tool}: {state}",
  noPicture: "Waiting for the first image.",
  install: "Install a certificate",
  issued: "Issued {day} by {person}",
  issuedOnly: "Issued {day}",
  pdf: "Certificate as PDF",
  json: "Certificate as JSON",
  guide: "How to test the accuracy",
};

export type CertificateTexts = typeof certificateEn;
