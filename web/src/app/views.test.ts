import { expect, test } from "vitest";
import { viewAt } from "./views";

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
