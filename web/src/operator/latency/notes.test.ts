import { expect, test } from "vitest";
import { message, snapshot } from "../../live/builders";
import { LatencyNotes } from "./notes";

const shown = (imageNumber: number, receivedAtMs: number, sentAtS = 100) => ({
  message: message({ sent_at_s: sentAtS, snapshot: snapshot({ image_number: imageNumber }) }),
  receivedAtMs,
});

test("a picture is shown by the screen image after it was drawn", () => {
  const notes = new LatencyNotes();
  notes.frame(1000);
  notes.draw(shown(7, 1004, 99.9));
  notes.frame(1017);
  notes.frame(1033);
  expect(notes.conclusion("ito", 1280, 800).shown).toEqual([
    { image_number: 7, sent_at_s: 99.9, received_at_ms: 1004, shown_at_ms: 1017 },
  ]);
});

test("a code and a picture of one screen image have the same moment", () => {
  const notes = new LatencyNotes();
  notes.draw(shown(7, 1004));
  notes.frame(1017);
  notes.paint(3, 1017);
  const { painted, shown: images } = notes.conclusion("ito", 1280, 800);
  expect(painted[0]?.painted_at_ms).toBe(images[0]?.shown_at_ms);
});

test("images from before the camera saw a code are left out, and codes on their way are kept", () => {
  const notes = new LatencyNotes();
  notes.paint(1, 900);
  notes.draw(shown(7, 905));
  notes.frame(917);
  notes.begin();
  notes.draw(shown(8, 940));
  notes.frame(950);
  const { painted, shown: images } = notes.conclusion("ito", 1280, 800);
  expect(painted).toEqual([{ code: 1, painted_at_ms: 900 }]);
  expect(images.map((one) => one.image_number)).toEqual([8]);
});

test("the screen's period is the usual one, whatever a busy page leaves out", () => {
  const notes = new LatencyNotes();
  for (const at of [0, 10, 20, 30, 530, 540, 550]) notes.frame(at);
  notes.compare(5, 8, 42);
  expect(notes.conclusion("ito", 1280, 800)).toMatchObject({
    made_by: "ito",
    comparisons: [{ requested_at_ms: 5, responded_at_ms: 8, server_s: 42 }],
    screen: { width_px: 1280, height_px: 800, period_ms: 10 },
  });
});

test("no more is sent than is taken, and the newest of it", () => {
  const notes = new LatencyNotes();
  for (let code = 0; code < 1100; code += 1) notes.paint(code % 250, code);
  const { painted } = notes.conclusion("ito", 1280, 800);
  expect(painted).toHaveLength(1000);
  expect(painted.at(-1)).toEqual({ code: 99, painted_at_ms: 1099 });
});
