import { expect, test } from "vitest";
import { isInSight, throughAll } from "./inSight";

const SEEN = { top: 80, bottom: 800 };

test.each([
  ["wholly in the middle", { top: 200, bottom: 400 }, true],
  ["exactly filling it", SEEN, true],
  ["below the fold", { top: 900, bottom: 1100 }, false],
  ["begun, but cut off below", { top: 700, bottom: 900 }, false],
  ["under the band at the top", { top: 40, bottom: 300 }, false],
  ["higher than the window, from its beginning", { top: 80, bottom: 2000 }, true],
  ["higher than the window, from its middle", { top: -300, bottom: 2000 }, false],
] as const)("%s", (_, box, inSight) => {
  expect(isInSight(box, SEEN)).toBe(inSight);
});

test("a scrolling panel hides what is outside of it", () => {
  const seen = throughAll([SEEN, { top: 300, bottom: 700 }]);
  expect(seen).toEqual({ top: 300, bottom: 700 });
  expect(isInSight({ top: 200, bottom: 400 }, seen)).toBe(false);
});
