// What the list of theatres may show now. Pure: the hub's ages are upper bounds at its answer, which was sent after
// the page had asked; counted from the question on they stay upper bounds, whatever the hub does afterwards.
import { formatDuration } from "../live/rounding";
import type { HubTheatreMessage, HubTheatresMessage } from "../api";

export interface Heard {
  message: HubTheatresMessage;
  askedAtMs: number;
}

/** A theatre as it may be shown now: what is too old has its age and nothing else. */
export interface ShownTheatre {
  name: string;
  presence: HubTheatreMessage["presence"];
  /** Age of its newest message, at most; null where it is not measured. */
  ageMs: number | null;
  /** Age of its newest image, at most; null without one, and where it is not live. */
  imageAgeMs: number | null;
  /** Null where it is not live. */
  state: Pick<HubTheatreMessage, "headline" | "tone" | "alarms"> | null;
}

export function theatresAt({ message, askedAtMs }: Heard, nowMs: number): ShownTheatre[] {
  const sinceMs = nowMs - askedAtMs;
  return message.theatres.map((one) => {
    const ageMs = one.age_ms === null ? null : one.age_ms + sinceMs;
    const isOld = !((ageMs ?? sinceMs) <= message.stale_after_ms);
    const presence = isOld && one.presence !== "gone" ? "stale" : one.presence;
    const isLive = presence === "live";
    return {
      name: one.name,
      presence,
      ageMs,
      imageAgeMs: !isLive || one.image_age_ms === null ? null : one.image_age_ms + sinceMs,
      state: isLive ? one : null,
    };
  });
}

/** Whether the hub itself has not answered for so long that all theatres are stale. */
export function isHubSilent(heard: Heard, nowMs: number): boolean {
  return nowMs - heard.askedAtMs > heard.message.stale_after_ms;
}

/** An upper bound of an age, rounded up. */
export function formatBound(ageMs: number): string {
  return formatDuration(Math.ceil(Math.max(ageMs, 0) / 100) * 100);
}
