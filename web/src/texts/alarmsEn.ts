// The alarms in English.
import type { Texts } from "./en";

export const alarmsEn: Texts["alarms"] = {
  title: "Alarms",
  none: "No alarm",
  all: "All alarms",
  details: "Details",
  unknown: "ALARMS UNKNOWN: the server does not answer",
  acknowledge: "Acknowledge",
  pause: "Pause sound 120\u00a0s",
  paused: "Sound paused",
  resume: "Turn sound on",
  failed: "The server did not receive or log this. Try again.",
  arm: "SOUND NOT ARMED: touch here",
  armFailed: "NO SOUND: touch here to try again",
  armed: "Sound armed",
  over: "OVER, NOT ACKNOWLEDGED",
  priority: { high: "HIGH", medium: "MEDIUM", low: "LOW" },
};
