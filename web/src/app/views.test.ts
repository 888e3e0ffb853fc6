import { expect, test } from "vitest";
import { homeOf, isCameraAt, viewAt } from "./views";

test.each([
  ["/", "operator", "theatre"],
  ["/operator/plan", "operator", "operator"],
  ["/operators", "operator", "theatre"],
  ["/operator/plan", "viewer", "theatre"],
  ["/supervisor", "supervisor", "supervisor"],
  ["/operator", "supervisor", "theatre"],
  ["/theatre", "screen", "theatre"],
  ["/nonsense", "screen", "theatre"],
] as const)("%s shows a %s the %s view", (path, role, view) => {
  expect(viewAt(path, role)).toBe(view);
});

test.each([
  ["/camera", "operator", true],
  ["/camera", "camera", true],
  ["/theatre", "camera", true],
  ["/operator", "operator", false],
  ["/camera", "viewer", false],
  ["/camera", "supervisor", false],
] as const)("a device at %s, signed in as %s, is the camera: %s", (path, role, is) => {
  expect(isCameraAt(path, role)).toBe(is);
});

test("a camera begins where it sends, everybody else where they look", () => {
  expect([homeOf("camera"), homeOf("operator"), homeOf("screen")]).toEqual([
    "/camera",
    "/operator",
    "/theatre",
  ]);
});
