import { expect, test } from "vitest";
import { clampSpan, moveSpan, ratioAt, timeAt, zoomSpan } from "./span";

const WHOLE = { fromS: 0, toS: 100 };

test.each([
  [
    { fromS: -20, toS: 20 },
    { fromS: 0, toS: 40 },
  ],
  [
    { fromS: 90, toS: 130 },
    { fromS: 60, toS: 100 },
  ],
  [
    { fromS: 50, toS: 50 },
    { fromS: 49.5, toS: 50.5 },
  ],
  [{ fromS: -50, toS: 400 }, WHOLE],
])("%o becomes %o", (span, clamped) => {
  expect(clampSpan(span, 100)).toEqual(clamped);
});

test("a recording of half a second is shown in a second", () => {
  expect(clampSpan({ fromS: 0, toS: 0.5 }, 0.5)).toEqual({ fromS: 0, toS: 1 });
});

test("what a zoom is about stays where it is, and the way back gives the whole", () => {
  const near = zoomSpan(WHOLE, 4, 40, 100);
  expect(near).toEqual({ fromS: 30, toS: 55 });
  expect(ratioAt(near, 40)).toBeCloseTo(ratioAt(WHOLE, 40));
  expect(zoomSpan(near, 1 / 8, 40, 100)).toEqual(WHOLE);
});

test("it is moved by a share of itself, up to the end", () => {
  expect(moveSpan({ fromS: 0, toS: 20 }, 0.5, 100)).toEqual({ fromS: 10, toS: 30 });
  expect(moveSpan({ fromS: 70, toS: 90 }, 5, 100)).toEqual({ fromS: 80, toS: 100 });
});

test("a place in the chart and its time are the same", () => {
  expect(timeAt({ fromS: 20, toS: 60 }, ratioAt({ fromS: 20, toS: 60 }, 33))).toBeCloseTo(33);
});
