import { describe, expect, test } from "vitest";
import type { Priority } from "../live/messages";
import { isLit } from "./flash";

/** Sampled at 60 Hz for 10 s. */
function watched(priority: Priority, fromMs: number): { hz: number; onRatio: number } {
  const looks = Array.from({ length: 600 }, (_, number) => isLit(priority, fromMs + (number * 1000) / 60));
  const rises = looks.filter((lit, number) => lit && number > 0 && looks[number - 1] === false).length;
  return { hz: rises / 10, onRatio: looks.filter(Boolean).length / looks.length };
}

describe.each([0, 123.4, 86_400_000.7])("from %d ms on", (fromMs) => {
  test("high flashes 1.4 to 2.8 times a second", () => {
    const { hz, onRatio } = watched("high", fromMs);
    expect(hz).toBeGreaterThanOrEqual(1.4);
    expect(hz).toBeLessThanOrEqual(2.8);
    expect(onRatio).toBeGreaterThan(0.2);
    expect(onRatio).toBeLessThan(0.6);
  });

  test("medium flashes 0.4 to 0.8 times a second", () => {
    const { hz, onRatio } = watched("medium", fromMs);
    expect(hz).toBeGreaterThanOrEqual(0.4);
    expect(hz).toBeLessThanOrEqual(0.8);
    expect(onRatio).toBeGreaterThan(0.2);
    expect(onRatio).toBeLessThan(0.6);
  });

  test("low never flashes", () => {
    expect(watched("low", fromMs)).toEqual({ hz: 0, onRatio: 1 });
  });
});
