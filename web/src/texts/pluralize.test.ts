import { expect, test } from "vitest";
import { de } from "./de";
import { en } from "./en";
import { pluralize } from "./pluralize";

test.each([
  [0, "0 images missing", "0 Bilder fehlen"],
  [1, "1 image missing", "1 Bild fehlt"],
  [2, "2 images missing", "2 Bilder fehlen"],
])("%d missing images are counted as %s, %s", (count, english, german) => {
  expect(pluralize(en.recording.missing, count, "en")).toBe(english);
  expect(pluralize(de.recording.missing, count, "de")).toBe(german);
});

test("other gaps are filled by name", () => {
  expect(pluralize(en.case.filesCount, 1, "en", { size: "2 MB" })).toBe("1 file, 2 MB");
});
