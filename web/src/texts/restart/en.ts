export const restartEn = {
  title: "Navigation stopped",
  because: {
    server_started:
      "The server was restarted. No numbers relative to the channel are shown until this is confirmed.",
    tracking_started: "Tracking was restarted. A movement of the camera in the meantime was not detected.",
  },
  look: {
    reference: "Is this the same patient, and is the marker on the bone unchanged?",
    camera: "Does the channel in the picture still lie on the bone?",
  },
  confirm: "Confirm and continue with",
  others: "The operator must confirm this.",
  orCheck: "If in doubt, check on a landmark.",
};

export type RestartTexts = typeof restartEn;
