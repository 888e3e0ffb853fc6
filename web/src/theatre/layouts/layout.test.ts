import { expect, test } from "vitest";
import { isFiguresScreen, layoutInAddress, screenAddress } from "./layout";
import { FIRST_LAYOUT, readLayout } from "./storedLayout";

test("the address chooses a layout or the screen with figures, and keeps its language", () => {
  expect(layoutInAddress("?layout=drill")).toBe("drill");
  expect(layoutInAddress("?layout=figures")).toBeNull();
  expect(isFiguresScreen("?lang=de&layout=figures")).toBe(true);
  expect(isFiguresScreen("?layout=drill")).toBe(false);
  expect(screenAddress("?lang=de", "figures")).toBe("/theatre?lang=de&layout=figures");
  expect(screenAddress("?layout=figures", "theatre")).toBe("/theatre");
});

test("what was stored is read, and what is not understood is ignored", () => {
  const stored = { layout: "align", isAutomatic: true, keys: { drill: "F8" } };
  expect(readLayout(JSON.stringify(stored))).toEqual(stored);
  const strange = {
    layout: "upside-down",
    isAutomatic: "yes",
    keys: { drill: "Enter", jump: "F1", align: 5 },
  };
  for (const text of [null, "{", "7", JSON.stringify(strange)]) {
    expect(readLayout(text)).toEqual(FIRST_LAYOUT);
  }
});
