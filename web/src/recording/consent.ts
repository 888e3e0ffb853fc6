// Consent to recording, and whom the page asks for it. Pure.
import type { ConsentMessage } from "../api";
import type { Recording } from "./recordingText";

export type Consent = ConsentMessage;

/** Whether a recording may start without a question. */
export function isConsented(consent: Consent): boolean {
  return consent.state === "given" || consent.state === "not_required";
}

/** Whether the page asks unprompted: recording would begin with navigation and consent is unanswered. */
export function isConsentPromptDue(recording: Recording): boolean {
  return recording.when === "navigating" && recording.consent.state === "not_answered";
}
