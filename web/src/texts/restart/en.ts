export const restartEn = {
  title: "Navigation stopped",
  because: {
    server_started:
      "The server was started again. Nothing is shown against the channel until it is confirmed.",
    tracking_started: "Tracking was started again. Nobody saw whether the camera was moved meanwhile.",
  },
  look: {
    reference: "Is this the patient, and is the marker on the bone untouched?",
    camera: "Does the channel in the picture still lie on the bone?",
  },
  confirm: "Confirm: go on with",
  others: "The operator confirms it.",
  orCheck: "If in doubt, check on a landmark.",
};

export type RestartTexts = typeof restartEn;
