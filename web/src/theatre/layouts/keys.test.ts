import { expect, test } from "vitest";
import { layoutByKey, withKey, withoutKey, type Keys } from "./keys";

const KEYS: Keys = { drill: "F8", next: "PageDown" };
const press = (code: string, changes = {}) => ({
  code,
  repeat: false,
  altKey: false,
  ctrlKey: false,
  metaKey: false,
  ...changes,
});

test("a key that is set chooses its layout or the next one", () => {
  expect(layoutByKey(press("F8"), KEYS, "overview")).toBe("drill");
  expect(layoutByKey(press("PageDown"), KEYS, "align")).toBe("drill");
  expect(layoutByKey(press("PageDown"), KEYS, "overview")).toBe("approach");
});

test("no other key does anything, nor one that is held or pressed with Ctrl", () => {
  expect(layoutByKey(press("F9"), KEYS, "overview")).toBeNull();
  expect(layoutByKey(press("F8"), {}, "overview")).toBeNull();
  expect(layoutByKey(press("F8", { repeat: true }), KEYS, "overview")).toBeNull();
  expect(layoutByKey(press("F8", { ctrlKey: true }), KEYS, "overview")).toBeNull();
  // A focused button takes these: they could acknowledge an alarm.
  for (const code of ["Enter", "Space"])
    expect(layoutByKey(press(code), { drill: code }, "align")).toBeNull();
});

test("a key has one action", () => {
  expect(withKey(KEYS, "align", "F8")).toEqual({ align: "F8", next: "PageDown" });
  expect(withoutKey(KEYS, "next")).toEqual({ drill: "F8" });
});
