// Whether the patient consented to being recorded, and whom the page asks. Pure.
import type { components } from "../schema";
import type { Recording } from "./recordingText";

export type Consent = components["schemas"]["ConsentMessage"];

/** Whether a recording may start without a question. */
export function isConsented(consent: Consent): boolean {
  return consent.state === "given" || consent.state === "not_required";
}

/** Whether the page asks by itself: a recording would begin with navigation, and nobody has answered yet. */
export function isConsentPromptDue(recording: Recording): boolean {
  return recording.when === "navigating" && recording.consent.state === "not_answered";
}
