import { beforeEach, expect, test } from "vitest";
import { isSceneNote, SceneAge } from "./sceneAge";

let scene: SceneAge;
const note = (image_number: number | null, connected = true) =>
  ({ kind: "coaxial-scene", image_number, connected, drawn_by_processor: false }) as const;

beforeEach(() => {
  scene = new SceneAge();
  for (let number = 0; number <= 30; number += 3) scene.image(number, 1000 + number * 33);
});

test("loads until its first image", () => {
  expect(scene.verdict(2000, 500)).toEqual({ state: "loading" });
  scene.drawn(note(null, false), 2000);
  expect(scene.verdict(2000, 500)).toEqual({ state: "loading" });
  scene.drawn(note(null), 2000);
  expect(scene.verdict(2000, 500)).toEqual({ state: "loading" });
});

test("is live with the newest image, and states its lag", () => {
  scene.drawn(note(28), 2000);
  // 28 was skipped by this page; 27 bounds its age from above.
  expect(scene.verdict(2000, 500)).toEqual({
    state: "live",
    imageNumber: 28,
    behindImages: 2,
    ageMs: 2000 - (1000 + 27 * 33),
  });
});

test("becomes stale when its image gets old", () => {
  scene.drawn(note(30), 2000);
  expect(scene.verdict(2491, 500)).toMatchObject({ state: "stale", imageNumber: 30 });
});

test("is stale when it reports no connection, however recent its image is", () => {
  scene.drawn(note(30), 2000);
  scene.verdict(2000, 500);
  scene.drawn(note(30, false), 2000);
  expect(scene.verdict(2001, 500).state).toBe("stale");
});

test("what repeats one number does not get younger", () => {
  scene.drawn(note(30), 2000);
  scene.drawn(note(30), 2480);
  expect(scene.verdict(2501, 500).state).toBe("stale");
});

test("an image number from before a restart does not count as new", () => {
  scene.drawn(note(5000), 2000);
  expect(scene.verdict(2001, 500).state).toBe("stale");
  scene.drawn(note(30), 2001);
  expect(scene.verdict(2001, 500).state).toBe("live");
  scene.image(0, 2010); // the source restarts its count
  expect(scene.verdict(2011, 500)).toMatchObject({ state: "stale", imageNumber: null });
});

test.each([
  [null, false],
  ["coaxial-scene", false],
  [{ kind: "other", image_number: 1, connected: true }, false],
  [{ kind: "coaxial-scene", image_number: "1", connected: true }, false],
  [{ kind: "coaxial-scene", image_number: 1.5, connected: true }, false],
  [note(1), true],
  [note(null, false), true],
])("%j is a note of the scene: %s", (value, is) => {
  expect(isSceneNote(value)).toBe(is);
});
