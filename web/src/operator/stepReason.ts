// Reason and remedy of a step in the page's language. The server writes them in English; for other languages they are
// derived from the step's state and numbers where these determine the reason.
import type { Procedure, Step } from "../app/procedure";
import { formatNumber } from "../live/rounding";
import type { Texts } from "../texts/catalogue";
import { interpolate } from "../texts/interpolate";
import { stepReasonsDe, type StepReasons } from "../texts/operator/stepReasonsDe";
import { sentence } from "./parts/format";

const BY_LANGUAGE: Partial<Record<string, StepReasons>> = { de: stepReasonsDe };

export interface StepReason {
  message: string;
  remedy: string;
  /** The language of both. */
  lang: string;
}

/** The reason in the page's language, else the server's English. */
export function stepReason(step: Step, procedure: Procedure, texts: Texts): StepReason {
  const reasons = BY_LANGUAGE[texts.language];
  const known = reasons === undefined ? null : knownReason(step, procedure, texts);
  if (reasons === undefined || known === null)
    return { message: sentence(step.message), remedy: step.remedy, lang: "en" };
  const { message, remedy } = reasons[known.key];
  return { message: interpolate(message, known.gaps), remedy, lang: texts.language };
}

interface KnownReason {
  key: keyof StepReasons;
  gaps: Record<string, string>;
}

const known = (key: keyof StepReasons, gaps: Record<string, string> = {}): KnownReason => ({ key, gaps });

const isValid = ({ state }: Step): boolean => state === "done" || state === "due";

/** Null where state and numbers leave several reasons, as for everything that is out of date. */
function knownReason(step: Step, procedure: Procedure, texts: Texts): KnownReason | null {
  if (procedure.case_id === null) return known("noCase");
  const { state, numbers, document_id: made } = step;
  switch (step.step) {
    case "camera":
      if (state === "missing") return known("cameraMissing");
      if (state === "done" && made === null) return known("cameraOfSettings");
      if (state === "done") return known("maximum_error_mm" in numbers ? "cameraChecked" : "cameraDone");
      if (state === "failed")
        return measured("cameraFailed", numbers, ["error", "maximum_error_mm"], "limit_mm");
      return null;
    case "tool":
      return state === "missing" ? known(made === null ? "toolMissing" : "axisMissing") : null;
    case "plan":
      if (state === "missing") return known(made === null ? "planMissing" : "channelMissing");
      return state === "done" ? known("planDone") : null;
    case "register":
      if (state === "missing") return known(hasChannel(procedure) ? "registrationMissing" : "channelMissing");
      return state === "done" ? registered(numbers["method"], texts) : null;
    case "check":
      return checkReason(step, procedure);
    case "navigate":
      return navigationReason(step, procedure, texts);
  }
}

const hasChannel = ({ steps }: Procedure): boolean =>
  steps.some((one) => one.step === "plan" && isValid(one));

function registered(method: Step["numbers"][string] | undefined, texts: Texts): KnownReason | null {
  const names: Partial<Record<string, string>> = texts.registration.method;
  const name = typeof method === "string" ? names[method] : undefined;
  return name === undefined ? null : known("registrationDone", { method: name });
}

function checkReason({ state, numbers }: Step, { steps }: Procedure): KnownReason | null {
  const registration = steps.find((one) => one.step === "register");
  if (state === "missing") return known(registration?.state === "done" ? "checkMissing" : "nothingToCheck");
  const { landmark, age_min: minutes } = numbers;
  if (typeof landmark !== "string") return null;
  if (state === "due")
    // A negative age means that the clock was set back.
    return typeof minutes === "number" && minutes >= 0
      ? known("checkDue", { landmark, minutes: formatNumber(minutes, 0) })
      : null;
  if (state !== "done" && state !== "failed") return null;
  const key = state === "done" ? "checkDone" : "checkFailed";
  const reason = measured(key, numbers, ["distance", "distance_mm"], "max_mm");
  return reason === null ? null : known(key, { ...reason.gaps, landmark });
}

function navigationReason({ state }: Step, procedure: Procedure, texts: Texts): KnownReason | null {
  if (state === "done") return known("navigationDone");
  const waiting = procedure.steps.filter((one) => one.step !== "navigate" && !isValid(one));
  const isUnsigned = procedure.steps.some((one) => one.missing_cosignature !== null);
  const isUnconfirmed = procedure.confirmation !== null;
  if (waiting[0] !== undefined)
    // With a check that is not required, the server may wait for these instead.
    return isUnsigned || isUnconfirmed
      ? null
      : known("navigationWaits", { step: texts.operator.page[waiting[0].step] });
  if (isUnsigned) return known("navigationUnsigned");
  return isUnconfirmed ? known("navigationUnconfirmed") : null;
}

/** A reason with a value and its limit, both in mm; null if one of them is missing. */
function measured(
  key: keyof StepReasons,
  numbers: Step["numbers"],
  [gap, name]: [string, string],
  maxName: string,
): KnownReason | null {
  const value = numbers[name];
  const max = numbers[maxName];
  if (typeof value !== "number" || typeof max !== "number") return null;
  return known(key, { [gap]: formatNumber(value, 2), max: formatNumber(max, 2) });
}
