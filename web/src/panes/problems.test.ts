import { expect, test } from "vitest";
import type { View } from "../live/live";
import { noteOf } from "./problems";

const NOTE = { code: "LAMP_FLICKER", message: { en: "a", de: "b" }, remedy: { en: "c", de: "d" } };
const camera = { clock: "driver", requested: null, granted: null, controls: {}, note: NOTE };
const viewOf = (source: unknown): View => ({ newest: source === null ? null : { source } }) as View;

test("a camera's note is shown while there is one", () => {
  expect(noteOf(viewOf({ camera }))).toEqual(NOTE);
  expect(noteOf(viewOf({ camera: { ...camera, note: null } }))).toBeNull();
  expect(noteOf(viewOf({ camera: null }))).toBeNull();
  expect(noteOf(viewOf(null))).toBeNull();
});
