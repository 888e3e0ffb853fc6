import { expect, test } from "vitest";
import { filled } from "./filled";

test("gaps are filled by name, and one that nobody fills is left to be seen", () => {
  expect(filled("{count} of {all} in {place}", { count: 2, all: 3 })).toBe("2 of 3 in {place}");
});
