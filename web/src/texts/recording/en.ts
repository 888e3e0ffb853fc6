export const recordingEn = {
  on: "REC",
  off: "not recording",
  stopped: "recording stopped",
  unknown: "recording not known",
  lasts: "disk lasts {time}",
  missing: "{count} images missing",
  start: "Record",
  stop: "Stop recording",
  consent: {
    title: "Has the patient consented to recording?",
    sentence:
      "A recording has images of the operation, figures and alarms, and names of staff. Your name and the time are stored with the answer.",
    navigating: "Recording begins with navigation. Without consent nothing is recorded.",
    yes: "Patient has consented",
    no: "Not now",
  },
  /** By the code of the server's problem. */
  reasons: {
    RECORDING_DISK_FULL: "the disk is full",
    RECORDING_BUDGET_EXCEEDED: "all recordings together are as large as they may be",
    RECORDING_NOT_WRITTEN: "the disk could not be written",
    RECORDING_PROCESS_ENDED: "its process ended",
  } as Record<string, string>,
};

export type RecordingTexts = typeof recordingEn;
