import { describe, expect, test } from "vitest";
import { sentence, formatBytes, formatClock, formatSecond, formatTime } from "./format";

describe("sizes", () => {
  test.each([
    [0, "0 B"],
    [999, "999 B"],
    [1000, "1.0 kB"],
    [12_345_678, "12.3 MB"],
    [345_678_901, "346 MB"],
    [5_000_000_000_000, "5000 GB"],
  ])("%d bytes", (bytes, shown) => {
    expect(formatBytes(bytes)).toBe(shown);
  });
});

test("a time is of where the page is, and what is none is shown as it is", () => {
  expect(formatTime("2026-03-01T23:30:00.000Z", "en", "Europe/Berlin")).toBe("2 Mar 2026, 00:30");
  expect(formatTime("2026-03-01T23:30:00.000Z", "de", "UTC")).toBe("01.03.2026, 23:30");
  expect(formatTime("later", "en")).toBe("later");
  expect(formatSecond("2026-03-01T23:30:05.900Z", "de", "UTC")).toBe("01.03.2026, 23:30:05");
  expect(formatClock("2026-03-01T23:30:05.900Z", "en", "Europe/Berlin")).toBe("00:30:05");
});

test("a sentence begins large and ends", () => {
  expect(sentence("the board moves: hold it still")).toBe("The board moves: hold it still.");
  expect(sentence("Show it.")).toBe("Show it.");
  expect(sentence("")).toBe("");
});
