// The alarms in English.
import type { Texts } from "./en";

export const alarmsEn: Texts["alarms"] = {
  title: "Alarms",
  none: "No alarm",
  unknown: "ALARMS NOT KNOWN: the server is not heard",
  acknowledge: "Acknowledge",
  pause: "Pause sound 120 s",
  paused: "Sound paused",
  resume: "sound again",
  failed: "That did not reach the server, or could not be logged. Try again.",
  arm: "SOUND NOT ARMED: touch here",
  armFailed: "SOUND DOES NOT WORK: touch here to try again",
  armed: "Sound armed",
  over: "OVER, NOT ACKNOWLEDGED",
  priority: { high: "HIGH", medium: "MEDIUM", low: "LOW" },
};
