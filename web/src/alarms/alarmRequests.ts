// Alarm actions of this screen, and its report to the server.
import createClient from "openapi-fetch";
import type { paths } from "../schema";

const server = createClient<paths>({ baseUrl: location.origin });
const SCREENS = "/api/alarms/screens";

/** Identifier of this page load. */
const SCREEN = Array.from(crypto.getRandomValues(new Uint8Array(8)), (byte) =>
  byte.toString(16).padStart(2, "0"),
).join("");
/** Without sign-in, actions are attributed to the screen. */
const BY = `screen ${SCREEN.slice(0, 4)}`;

export async function acknowledge(numbers: number[]): Promise<boolean> {
  return done(() => server.POST("/api/alarms/acknowledgement", { body: { by: BY, numbers } }));
}

export async function pause(seconds: number): Promise<boolean> {
  return done(() => server.POST("/api/alarms/pause", { body: { by: BY, seconds } }));
}

export async function resume(): Promise<boolean> {
  return done(() => server.POST("/api/alarms/resumption", { body: { by: BY } }));
}

export async function reportArmed(armed: boolean, signal: AbortSignal): Promise<boolean> {
  const state = armed ? "armed" : "silent";
  return done(() => server.POST(SCREENS, { body: { screen: SCREEN, state }, signal }));
}

/** Reports that the page closes, so that the screen does not count as lost. */
export function reportClosed(): void {
  const body = JSON.stringify({ screen: SCREEN, state: "closed" });
  navigator.sendBeacon(SCREENS, new Blob([body], { type: "application/json" }));
}

async function done(ask: () => Promise<{ response: Response }>): Promise<boolean> {
  try {
    return (await ask()).response.ok;
  } catch {
    return false;
  }
}
