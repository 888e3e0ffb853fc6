import { expect, test } from "vitest";
import { lastStep, read, withChange, withoutLast } from "./undo";

test("changes are taken back one after the other, each as a new version", () => {
  // Version 1 existed; two changes here made 2 and 3.
  let steps = withChange(withChange([], "one", 2), "two", 3);
  expect(lastStep(steps, 3)?.documentId).toBe("two");
  steps = withoutLast(steps, 4);
  expect(lastStep(steps, 4)?.documentId).toBe("one");
  steps = withoutLast(steps, 5);
  expect(lastStep(steps, 5)).toBeNull();
});

test("what somebody else changed since is not taken back", () => {
  expect(lastStep(withChange([], "one", 2), 3)).toBeNull();
});

test("the first change leads back to no plan", () => {
  expect(lastStep(withChange([], null, 1), 1)).toEqual({ documentId: null, madeVersion: 1 });
});

test("thirty changes are remembered", () => {
  let steps = read(null);
  for (let version = 1; version < 50; version += 1) steps = withChange(steps, `d${version}`, version);
  expect(steps).toHaveLength(30);
  expect(lastStep(steps, 49)?.documentId).toBe("d49");
});

test.each([["not JSON"], ["{}"], [null]])("what is stored as %s is no change", (text) => {
  expect(read(text)).toEqual([]);
});
