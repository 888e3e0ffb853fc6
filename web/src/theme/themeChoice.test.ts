import { expect, test } from "vitest";
import { otherTheme, readTheme, themeOf } from "./themeChoice";

test("a page has the chosen theme, else the one that the browser prefers", () => {
  expect(themeOf(null, true)).toBe("light");
  expect(themeOf(null, false)).toBe("dark");
  expect(themeOf("dark", true)).toBe("dark");
  expect(themeOf("light", false)).toBe("light");
  expect(otherTheme("light")).toBe("dark");
});

test("a stored choice is read, and what is no theme is ignored", () => {
  expect(readTheme("light")).toBe("light");
  for (const stored of [null, "pink", '{"pages":"light"}']) expect(readTheme(stored)).toBeNull();
});
