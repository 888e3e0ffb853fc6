import { describe, expect, test } from "vitest";
import { de } from "../texts/de";
import { en } from "../texts/en";
import { LookReporter, viewPart, visiblePictures } from "./look";
import { lookText, shortLookText } from "./lookText";
import type { PageLook } from "./messages";

const box = (left: number, top: number, width: number, height: number) => ({
  left,
  top,
  right: left + width,
  bottom: top + height,
});
const SHOWN = { part: viewPart("drill"), pictures: ["axial" as const], isHidden: false };

test("pictures are listed by their size on the screen, without those that are scrolled away", () => {
  const pictures = [
    { name: "probe", box: box(0, 0, 100, 100) },
    { name: "video", box: box(100, 0, 300, 200) },
    { name: "scene", box: box(0, 590, 300, 300) },
    { name: "axial", box: box(0, -700, 300, 300) },
  ] as const;
  expect(visiblePictures(pictures, { width: 400, height: 600 })).toEqual(["video", "probe"]);
});

test.each([
  ["drill", "drill"],
  ["navigate", "navigate"],
  ["", null],
  [undefined, null],
  ["Mr Smith", null],
])("a part of a view is one of a list (%s)", (name, part) => {
  expect(viewPart(name)).toBe(part);
});

describe("what a page shows", () => {
  test("is reported when it changes, and anew on another connection", () => {
    const reporter = new LookReporter();
    const next = (shown = SHOWN, seat = 1) => {
      reporter.add(true, 80);
      return reporter.next(shown, seat);
    };
    expect(next()).toEqual({ part: "drill", pictures: ["axial"], freshness: "live", max_age_ms: 100 });
    expect(next()).toBeNull();
    expect(next({ ...SHOWN, part: viewPart("align") })?.part).toBe("align");
    expect(next({ ...SHOWN, part: viewPart("align") }, 2)?.part).toBe("align");
    expect(next({ ...SHOWN, isHidden: true }, 2)).toEqual({
      part: "drill",
      pictures: [],
      freshness: "hidden",
      max_age_ms: null,
    });
  });

  test("has the oldest age of the second, which does not waver at a limit", () => {
    const reporter = new LookReporter();
    const ages = [[80, 190, 60], [110], [98], [79], [230]].map((seconds) => {
      for (const ageMs of seconds) reporter.add(true, ageMs);
      return reporter.next(SHOWN, 1)?.max_age_ms ?? null;
    });
    expect(ages).toEqual([200, null, null, 100, 500]);
  });

  test("is not live if it was not for a part of the second, or says nothing", () => {
    const reporter = new LookReporter();
    reporter.add(true, 80);
    reporter.add(false, 900);
    reporter.add(true, 80);
    expect(reporter.next(SHOWN, 1)).toMatchObject({ freshness: "old", max_age_ms: null });
    reporter.add(true, 80);
    expect(reporter.next(SHOWN, 1)).toMatchObject({ freshness: "live" });
    expect(reporter.next(SHOWN, 1)).toMatchObject({ freshness: "old" });
  });
});

const PAGE: PageLook = {
  view: "supervisor",
  part: "drill",
  pictures: ["axial", "video", "scene"],
  freshness: "live",
  max_age_ms: 200,
};

test.each([
  [PAGE, "Supervisor, Drill · In-line axial, Video, 3-D · up to 200 ms old"],
  [
    { ...PAGE, part: null, pictures: [], freshness: "hidden", max_age_ms: null },
    "Supervisor · page in the background",
  ],
  [
    { ...PAGE, view: "operator", part: "plan", pictures: [], freshness: "old", max_age_ms: null },
    "Operator, Plan · picture too old",
  ],
  [{ ...PAGE, view: "theatre", part: "figures", pictures: [] }, "Theatre, Figures only · up to 200 ms old"],
] as [PageLook, string][])("in words", (page, text) => {
  expect(lookText(page, en)).toBe(text);
});

test("in few words, in German", () => {
  expect(shortLookText(PAGE, de)).toBe("Bohren · Axial am Bohrer · bis 200 ms alt");
});
