import { expect, test } from "vitest";
import { registrationDe } from "../../texts/registration/de";
import { registrationEn } from "../../texts/registration/en";
import { captureText } from "./captureText";

const SLOW = { images: 7, wanted: 12, rate_hz: 5, left_s: 1 };

test("a running capture states the remaining time at the camera's rate", () => {
  expect(captureText(SLOW, registrationEn.capture)).toBe(
    "7 of 12 images. Hold still for another 1.0 s, at 5.0 images/s.",
  );
  expect(captureText(SLOW, registrationDe.capture)).toContain("Noch 1.0 s ruhig halten, bei 5.0 Bildern/s");
});

test("before the second image no time is promised", () => {
  const first = { images: 1, wanted: 12, rate_hz: null, left_s: null };
  expect(captureText(first, registrationEn.capture)).toBe("1 of 12 images. Hold still.");
});
