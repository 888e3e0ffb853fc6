import { expect, test } from "vitest";
import { interpolate } from "./interpolate";

test("gaps are filled by name, and one that nobody fills is left to be seen", () => {
  expect(interpolate("{count} of {all} in {place}", { count: 2, all: 3 })).toBe("2 of 3 in {place}");
});

test("values come where the sentence names them, and a name without one stays to be seen", () => {
  expect(interpolate("{there} of {wanted} views", { there: 3, wanted: 12 })).toBe("3 of 12 views");
  expect(interpolate("{there} of {wanted}", { there: 0 })).toBe("0 of {wanted}");
});
