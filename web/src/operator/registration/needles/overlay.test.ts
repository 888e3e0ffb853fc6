import { describe, expect, test } from "vitest";
import {
  applyMatrix,
  cssMatrix,
  translateOverlay,
  pinchOverlay,
  placeOf,
  scaleOverlay,
  similarity,
  rotateOverlay,
  type Overlay,
  type Px,
} from "./overlay";

const AT: Overlay = { shift_px: [640, 360], rotation_deg: 10, scale_px_per_mm: 3, fade_ratio: 0.5 };
const SCREEN_TOP_LEFT: Px = [0, 0];

function near(actual: Px, expected: Px): void {
  expect(actual[0]).toBeCloseTo(expected[0], 6);
  expect(actual[1]).toBeCloseTo(expected[1], 6);
}

describe("the slice in the hand", () => {
  test("moves by as many pixels as the finger", () => {
    expect(translateOverlay(AT, [12, -5])).toEqual({ ...AT, shift_px: [652, 355] });
  });

  test("rotates clockwise about a point: right of it moves below it", () => {
    const after = rotateOverlay(AT, 90, [540, 360]);
    near(placeOf(after), [540, 460]);
    expect(after.rotation_deg).toBe(100);
  });

  test("has a turn between -180 and 180 degrees", () => {
    expect(rotateOverlay(AT, 175, [0, 0]).rotation_deg).toBe(-175);
    expect(rotateOverlay(AT, -195, [0, 0]).rotation_deg).toBe(175);
  });

  test("grows away from a point", () => {
    const after = scaleOverlay(AT, 2, [600, 300]);
    near(placeOf(after), [680, 420]);
    expect(after.scale_px_per_mm).toBe(6);
  });

  test("is never larger than the server takes, and is then where that size has it", () => {
    const after = scaleOverlay(AT, 1000, SCREEN_TOP_LEFT);
    expect(after.scale_px_per_mm).toBe(100);
    near(placeOf(after), [(640 * 100) / 3, (360 * 100) / 3]);
  });
});

const HANDS: [string, Overlay][] = [
  ["moved", translateOverlay(AT, [31, 17])],
  ["turned", rotateOverlay(AT, -33, [100, 700])],
  ["scaled", scaleOverlay(AT, 0.7, [900, 20])],
  ["pinched", pinchOverlay(AT, { from: [500, 300], to: [520, 310], ratio: 1.3, turnDeg: 25 })],
];

describe("what is drawn between two answers", () => {
  test.each(HANDS)("has the middle of the needles where the hand has it: %s", (_, hand) => {
    near(applyMatrix(similarity(AT, hand), placeOf(AT)), placeOf(hand));
  });

  test.each(HANDS)("has a point a millimetre away as far and as turned as the hand says: %s", (_, hand) => {
    const besides = ({ shift_px, rotation_deg, scale_px_per_mm }: Overlay): Px => {
      const radians = (rotation_deg * Math.PI) / 180;
      const [x, y] = shift_px;
      return [x + scale_px_per_mm * Math.cos(radians), y + scale_px_per_mm * Math.sin(radians)];
    };
    near(applyMatrix(similarity(AT, hand), besides(AT)), besides(hand));
  });

  test("is what the server drew, exactly, where nothing was moved", () => {
    near(applyMatrix(similarity(AT, AT), [123.25, 45.5]), [123.25, 45.5]);
  });

  test("keeps what was under two fingers under them", () => {
    const [from, to]: [Px, Px] = [
      [500, 300],
      [540, 260],
    ];
    const hand = pinchOverlay(AT, { from, to, ratio: 2, turnDeg: 40 });
    near(applyMatrix(similarity(AT, hand), from), to);
    const radians = (40 * Math.PI) / 180;
    near(applyMatrix(similarity(AT, hand), [510, 300]), [
      540 + 20 * Math.cos(radians),
      260 + 20 * Math.sin(radians),
    ]);
  });
});

test("a picture's first pixel is drawn half a pixel from its corner", () => {
  // Doubled and moved: the centre of pixel (0, 0) shall be at the centre of (10, 20).
  const style = cssMatrix([2, 0, 10, 0, 2, 20, 0, 0, 1]);
  const numbers = style.slice("matrix3d(".length, -1).split(",").map(Number);
  const [a, , , , , e] = numbers;
  expect([a, e]).toEqual([2, 2]);
  // Its corner (0, 0) is half a doubled pixel before that centre: 10.5 - 1.
  expect([numbers[12], numbers[13]]).toEqual([9.5, 19.5]);
});
