import { describe, expect, test } from "vitest";
import type { HubTheatreMessage } from "../api";
import { isHubSilent, theatresAt, type Heard } from "./heard";

const ALARM = { priority: "high", state: "active", title: "NO IMAGE" };

function heard(theatre: Partial<HubTheatreMessage>): Heard {
  const usual: HubTheatreMessage = {
    name: "OR-1",
    presence: "live",
    age_ms: 100,
    image_age_ms: 150,
    headline: "ON PATH",
    tone: "good",
    alarms: [ALARM],
  };
  const theatres = [{ ...usual, ...theatre }];
  return { message: { theatres, sees: ["OR-*"], stale_after_ms: 2000, problem: null }, askedAtMs: 5000 };
}

describe("a theatre in the list", () => {
  test("is as old as the hub said, and the time since the question", () => {
    const [shown] = theatresAt(heard({}), 5300);
    expect(shown).toMatchObject({ presence: "live", ageMs: 400, imageAgeMs: 450 });
    expect(shown?.state).toMatchObject({ headline: "ON PATH", alarms: [ALARM] });
  });

  test.each([
    ["the hub has stopped answering", {}, 6901, "stale"],
    ["its age was never measured", { presence: "unmeasured", age_ms: null }, 5100, "unmeasured"],
    ["its age was never measured, long ago", { presence: "unmeasured", age_ms: null }, 7001, "stale"],
    ["the hub says so", { presence: "stale", age_ms: 2500 }, 5100, "stale"],
    ["it is gone", { presence: "gone", age_ms: 20_000 }, 9000, "gone"],
    ["its age is no number", { age_ms: NaN }, 5100, "stale"],
  ] as const)("shows nothing but its age where %s", (_, theatre, nowMs, presence) => {
    const [shown] = theatresAt(heard(theatre), nowMs);
    expect(shown).toMatchObject({ presence, state: null, imageAgeMs: null });
  });
});

test("a hub that does not answer is silent after the same time", () => {
  expect(isHubSilent(heard({}), 7000)).toBe(false);
  expect(isHubSilent(heard({}), 7001)).toBe(true);
});
