import { expect, test } from "vitest";
import { SleepDetector } from "./sleepDetector";

test("a clock that stood still while the time of day went on means that the computer slept", () => {
  let wallMs = 1_000_000;
  let awakeMs = 5_000;
  const detector = new SleepDetector(
    () => wallMs,
    () => awakeMs,
  );
  wallMs += 4_000;
  awakeMs += 4_000;
  expect(detector.hasSlept()).toBe(false);
  wallMs += 30_050;
  awakeMs += 50;
  expect(detector.hasSlept()).toBe(true);
  expect(detector.hasSlept()).toBe(false);
  wallMs -= 3_600_000;
  expect(detector.hasSlept()).toBe(true);
});
