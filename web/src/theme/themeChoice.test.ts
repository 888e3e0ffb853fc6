import { expect, test } from "vitest";
import { otherTheme, readTheme, themeOf } from "./themeChoice";

test("a page has the chosen theme, else the one that the browser prefers, and a theatre screen is dark", () => {
  expect(themeOf(null, true, "/operator/plan")).toBe("light");
  expect(themeOf(null, true, "/theatre")).toBe("dark");
  expect(themeOf(null, false, "/")).toBe("dark");
  expect(themeOf("dark", true, "/")).toBe("dark");
  expect(themeOf("light", false, "/theatre")).toBe("light");
  expect(otherTheme("light")).toBe("dark");
});

test("a stored choice is read, and what is no theme is ignored", () => {
  expect(readTheme("light")).toBe("light");
  for (const stored of [null, "pink", '{"pages":"light"}']) expect(readTheme(stored)).toBeNull();
});
