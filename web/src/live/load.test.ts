import { expect, test } from "vitest";
import { Load } from "./load";

const TIMES = { atMs: 0, networkMs: 2, decodingMs: 8, drawingMs: 1, ageMs: 60 };

function largestPicture(camera: [number, number], space: readonly [number, number] | null): "full" | "half" {
  const load = new Load(() => 0);
  load.spacePx = space;
  load.shown(TIMES, { width_px: camera[0], height_px: camera[1] }, 1);
  return load.budget.largestPicture;
}

test.each<[string, [number, number], readonly [number, number] | null, "full" | "half"]>([
  ["a space of half its width", [1280, 720], [640, 500], "half"],
  ["a wide space of half its height", [1280, 720], [1200, 360], "half"],
  ["a space that needs more", [1280, 720], [700, 500], "full"],
  ["a space that is not known", [1280, 720], null, "full"],
  ["a small camera, whose half would show too little", [640, 480], [300, 300], "full"],
])("the picture for %s", (_, camera, space, size) => {
  expect(largestPicture(camera, space)).toBe(size);
});
