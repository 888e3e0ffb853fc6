import { expect, test } from "vitest";
import { ServerClock } from "./clock";

test("without a comparison, the stated age counts from receipt", () => {
  expect(new ServerClock().capturedAtMs(1000, 20, 55)).toBe(980);
});

test("an image never counts as younger than the server states", () => {
  const clock = new ServerClock();
  clock.sample(1000, 1000, 99); // claims that the image was captured in the future
  expect(clock.capturedAtMs(1000, 20, 100)).toBe(980);
});

test("half the round trip is taken out of the comparison", () => {
  const clock = new ServerClock();
  clock.sample(1000, 1100, 100);
  expect(clock.capturedAtMs(1500, 20, 100.2)).toBe(1250);
});

test.each([
  [1000, 2001],
  [1000, 999],
])("a sample from %d to %d is too uncertain and dropped", (requestedAtMs, answeredAtMs) => {
  const clock = new ServerClock();
  clock.sample(requestedAtMs, answeredAtMs, 1);
  expect(clock.capturedAtMs(1000, 20, 0)).toBe(980);
});

test("the quickest of the last samples counts: a slow one is off by half of its round trip", () => {
  const clock = new ServerClock();
  clock.sample(1000, 1010, 101.005);
  clock.sample(6000, 6400, 106.39);
  expect(clock.aheadMs).toBe(100_000);
  for (let i = 0; i < 8; i += 1) clock.sample(10_000, 10_100, 110.06);
  expect(clock.aheadMs).toBe(100_010);
});
