// Texts of registration and check: method and age. Pure.
import type { SnapshotMessage } from "../live/messages";
import type { Mood } from "../panes/Fact";
import type { TheatreTexts } from "../texts/theatre/en";
import type { Procedure } from "../app/procedure";

export interface StatusText {
  value: string;
  mood: Mood;
}

const MINUTES_OF_HOUR = 60;
const HOURS_FROM = 100;

/** Method of the registration from the newest image, and its age from the case. */
export function registrationText(
  snapshot: SnapshotMessage | null,
  procedure: Procedure | null,
  texts: TheatreTexts,
): StatusText | null {
  if (snapshot === null) return null;
  if (snapshot.registered_by === null) return { value: texts.notRegistered, mood: "bad" };
  const age = ageText(numberOf(procedure, "register", "age_min"), texts);
  const by = texts.by[snapshot.registered_by];
  return { value: age === "" ? by : `${by}, ${age}`, mood: "good" };
}

/** Result and age of the check; null if there is nothing to check. */
export function checkText(
  snapshot: SnapshotMessage | null,
  procedure: Procedure | null,
  texts: TheatreTexts,
): StatusText | null {
  const step = procedure?.steps.find((one) => one.step === "check") ?? null;
  if (snapshot === null || step === null || procedure?.case_id == null) return null;
  const age = ageText(numberOf(procedure, "check", "age_min"), texts);
  switch (step.state) {
    case "done":
      return { value: age, mood: "good" };
    case "due":
      return { value: `${age}, ${texts.checkDue}`, mood: "bad" };
    case "failed":
      return { value: texts.checkFailed, mood: "bad" };
    case "missing":
    case "out_of_date":
      return { value: texts.notChecked, mood: "bad" };
  }
}

export function ageText(minutes: number | null, texts: TheatreTexts): string {
  if (minutes === null || !(minutes >= 0)) return "";
  if (minutes < 1) return texts.justNow;
  if (minutes < HOURS_FROM) return `${Math.floor(minutes)} ${texts.minutesAgo}`;
  return `${Math.floor(minutes / MINUTES_OF_HOUR)} ${texts.hoursAgo}`;
}

function numberOf(procedure: Procedure | null, step: "register" | "check", name: string): number | null {
  const value = procedure?.steps.find((one) => one.step === step)?.numbers[name];
  return typeof value === "number" ? value : null;
}
