import { expect, test } from "vitest";
import { placeBeside } from "./place";

test.each([
  ["at the top of a tablet", 820, { top: 114, bottom: 250 }, 240, "bottom"],
  ["down to the card", 820, { top: 114, bottom: 568 }, 240, "bottom"],
  ["a pixel below its edge", 820, { top: 253, bottom: 569 }, 240, "top"],
  ["at the bottom of a phone", 844, { top: 430, bottom: 700 }, 330, "top"],
  ["in the middle of a phone", 844, { top: 300, bottom: 560 }, 330, "folded"],
  ["on a page scrolled below them", 844, { top: -400, bottom: -100 }, 330, "bottom"],
  ["below the window", 844, { top: 844, bottom: 1000 }, 330, "bottom"],
])("with the alarms %s", (_, heightPx, alarms, cardPx, place) => {
  expect(placeBeside({ heightPx, alarms, cardPx, marginPx: 12 })).toBe(place);
});
