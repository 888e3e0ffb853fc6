import { expect, test } from "vitest";
import { nextLandmark } from "./nextLandmark";

const landmarks = (touched: string): { name: string; touched: boolean }[] =>
  ["a", "b", "c"].map((name) => ({ name, touched: touched.includes(name) }));

test.each([
  ["the first that was not touched", "a", null, null, "b"],
  ["the one that was picked", "a", null, "a", "a"],
  ["the one that is looked for", "a", { landmark: "c", state: "looking" as const }, null, "c"],
  ["the one that was refused, again", "a", { landmark: "c", state: "rejected" as const }, null, "c"],
  ["nothing once only one is left, which the check needs", "ab", null, null, null],
  ["nothing that the plan does not have", "a", null, "z", "b"],
])("asks for %s", (_, touched, capture, picked, expected) => {
  expect(nextLandmark({ landmarks: landmarks(touched), capture }, picked)).toBe(expected);
});
