// Alarm actions of this screen, and its report to the server.
import {
  postAlarmsAcknowledgement,
  postAlarmsPause,
  postAlarmsResumption,
  postAlarmsScreens,
  type PostAlarmsScreensData,
} from "../api";

const SCREENS: PostAlarmsScreensData["url"] = "/api/alarms/screens";

/** Identifier of this page load. */
const SCREEN = Array.from(crypto.getRandomValues(new Uint8Array(8)), (byte) =>
  byte.toString(16).padStart(2, "0"),
).join("");
/** Without sign-in, actions are attributed to the screen. */
const BY = `screen ${SCREEN.slice(0, 4)}`;

let isGuiding = false;

/** Sets whether this screen plays the guiding sound, for its next report. */
export function setGuiding(isOn: boolean): void {
  isGuiding = isOn;
}

export async function acknowledge(numbers: number[]): Promise<boolean> {
  return done(postAlarmsAcknowledgement({ body: { by: BY, numbers } }));
}

export async function pause(seconds: number): Promise<boolean> {
  return done(postAlarmsPause({ body: { by: BY, seconds } }));
}

export async function resume(): Promise<boolean> {
  return done(postAlarmsResumption({ body: { by: BY } }));
}

export async function reportArmed(armed: boolean, signal: AbortSignal): Promise<boolean> {
  const state = armed ? "armed" : "silent";
  return done(postAlarmsScreens({ body: { screen: SCREEN, state, guiding_sound: isGuiding }, signal }));
}

/** Reports that the page closes, so that the screen does not count as lost. */
export function reportClosed(): void {
  const body = JSON.stringify({ screen: SCREEN, state: "closed" });
  navigator.sendBeacon(SCREENS, new Blob([body], { type: "application/json" }));
}

async function done(request: Promise<unknown>): Promise<boolean> {
  try {
    await request;
    return true;
  } catch {
    return false;
  }
}
