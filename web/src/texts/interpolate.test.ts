import { expect, test } from "vitest";
import { interpolate } from "./interpolate";

test("gaps are filled by name, and an unfilled gap stays visible", () => {
  expect(interpolate("{count} of {all} in {place}", { count: 2, all: 3 })).toBe("2 of 3 in {place}");
});

test("values replace their names, and a name without a value stays visible", () => {
  expect(interpolate("{there} of {wanted} views", { there: 3, wanted: 12 })).toBe("3 of 12 views");
  expect(interpolate("{there} of {wanted}", { there: 0 })).toBe("0 of {wanted}");
});
