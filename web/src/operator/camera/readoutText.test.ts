import { expect, test } from "vitest";
import { readoutEn } from "../../texts/camera/readout";
import { readoutText } from "./readoutText";

const NONE = { collecting: false, readout_ms: null, sd_ms: null, found_by: null };

test("a readout that is not known is not called a global shutter", () => {
  expect(readoutText(NONE, readoutEn)).toBe(readoutEn.notKnown);
  expect(readoutText({ ...NONE, readout_ms: 0, found_by: "stated" }, readoutEn)).toBe(
    readoutEn.global.stated,
  );
});

test("a measured readout is called measured", () => {
  const text = readoutText({ ...NONE, readout_ms: 16.04, sd_ms: 0.2, found_by: "measured" }, readoutEn);
  expect(text).toBe("Measured: 16.0 ms from the first row to the last.");
});
