import { expect, test } from "vitest";
import type { Job } from "../../rest/useJob";
import { de } from "../../texts/de";
import { en } from "../../texts/en";
import { exportOf, exportText } from "./recordingExport";

const FILE = { file: "a.mp4", size_bytes: 14_000_000, images: 120 };

test("a video states how many of its images have no results", () => {
  expect(exportText({ ...FILE, images_without_overlay: 0 }, en)).toBe(
    "120 images, 120 with the overlay. 14.0 MB",
  );
  expect(exportText({ ...FILE, images_without_overlay: 7 }, en)).toContain(
    "113 with the overlay. The others state why",
  );
});

test("a section states where it begins and whether it can be replayed exactly", () => {
  expect(exportText({ ...FILE, from_s: 61, is_exact: true }, en)).toContain(
    "from 1:01 on, where a tracking state",
  );
  expect(exportText({ ...FILE, from_s: 61, is_exact: true }, en)).toContain(
    "The section can be replayed exactly.",
  );
  const missing = exportText({ ...FILE, from_s: 61, is_exact: true, missing_images: 3 }, en);
  expect(missing).toContain("3 images in between were not recorded");
  expect(missing).not.toContain("can be replayed exactly");
  expect(exportText({ ...FILE, from_s: 61, is_exact: false }, de)).toContain("nicht wiederholbar");
});

test("tables state their rows, a sequence its transforms and the images without pixels", () => {
  expect(exportText({ file: "a.zip", size_bytes: 2_000_000, rows: 1 }, en)).toBe(
    "3 tables (Parquet) with 1 row. 2.0 MB",
  );
  const sequence = { ...FILE, frames: { "tool drill": "Drill", "vertebra ": "Vertebra" } };
  expect(exportText({ ...sequence, invalid_images: 0 }, en)).toBe(
    "120 images with the poses DrillToTracker, VertebraToTracker. 14.0 MB",
  );
  expect(exportText({ ...sequence, invalid_images: 2 }, de)).toContain("2 davon sind nicht dekodierbar");
});

test("what failed made nothing", () => {
  const job = { state: "done", result: FILE } as unknown as Job;
  expect(exportOf(job)).toEqual(FILE);
  expect(exportOf({ ...job, state: "failed" })).toBeNull();
});
