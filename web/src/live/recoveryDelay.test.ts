import { expect, test } from "vitest";
import { RecoveryDelay } from "./recoveryDelay";

test("after a single late image figures are shown again at once", () => {
  const delay = new RecoveryDelay();
  delay.isActive(true, 5000);
  delay.isActive(true, 5040);
  expect(delay.isActive(false, 5060)).toBe(false);
});

test("figures that were old twice within a second are suppressed until they have been young for a quarter of one", () => {
  const delay = new RecoveryDelay();
  delay.isActive(true, 5000);
  delay.isActive(false, 5060);
  delay.isActive(true, 5900);
  expect(delay.isActive(false, 5960)).toBe(true);
  expect(delay.isActive(false, 6149)).toBe(true);
  expect(delay.isActive(false, 6150)).toBe(false);
});

test("figures that are old again and again are not shown in between", () => {
  const delay = new RecoveryDelay();
  delay.isActive(true, 5000);
  delay.isActive(false, 5100);
  const shown = [];
  for (let nowMs = 5100; nowMs < 9000; nowMs += 200) {
    delay.isActive(true, nowMs);
    shown.push(!delay.isActive(false, nowMs + 100));
  }
  expect(shown).not.toContain(true);
});

test("after a second without an old figure the next late image counts as a single one", () => {
  const delay = new RecoveryDelay();
  for (const nowMs of [5000, 5400]) {
    delay.isActive(true, nowMs);
    delay.isActive(false, nowMs + 20);
  }
  delay.isActive(true, 6400);
  expect(delay.isActive(false, 6420)).toBe(false);
});
