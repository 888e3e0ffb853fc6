import { expect, test } from "vitest";
import { recordingEn } from "../texts/recording/en";
import { recording } from "./recordingBuilder";
import {
  clockDuration,
  clockTenths,
  detailsLine,
  recordingText,
  roughDuration,
  type Recording,
} from "./recordingText";

const textOf = (changes: Partial<Recording>): ReturnType<typeof recordingText> =>
  recordingText(recording(changes), recordingEn, "en");

test("a recording shows its duration, size and remaining time", () => {
  expect(textOf({})).toEqual({
    state: "on",
    title: "REC 12:34",
    details: ["1.2 GB", "disk space for 3 h"],
    warnings: [],
    serverReason: "",
  });
  expect(textOf({ remaining_s: null }).details).toEqual(["1.2 GB"]);
});

test("missing images and a disk that is nearly full are warnings", () => {
  const { details, warnings } = textOf({ missing_images: 12, remaining_s: 599 });
  expect(details).toEqual(["1.2 GB"]);
  expect(warnings).toEqual(["disk space for 9 min", "12 images missing"]);
});

test("warnings precede what a narrow header may truncate", () => {
  expect(detailsLine(textOf({ missing_images: 12 }))).toBe(
    "▲ 12 images missing · 1.2 GB · disk space for 3 h",
  );
});

test("an interrupted recording shows the reason, in the page's words if it has them", () => {
  const problem = {
    code: "RECORDING_DISK_FULL",
    message: "0.10 GB are free",
    remedy: "",
    context: {},
    language: "en",
  } as const;
  const ended = { is_recording: false, name: null, problem };
  expect(textOf(ended)).toMatchObject({ state: "stopped", details: ["the disk is full"], serverReason: "" });
  const other = textOf({ ...ended, problem: { ...problem, code: "SOMETHING_NEW" } });
  expect(other).toMatchObject({ state: "stopped", details: [], serverReason: "0.10 GB are free" });
  expect(textOf({ is_recording: false }).state).toBe("off");
});

test.each([
  [0.9, "0:00"],
  [59.99, "0:59"],
  [3723, "1:02:03"],
])("%d s are %s on the clock", (seconds, text) => {
  expect(clockDuration(seconds)).toBe(text);
});

test.each([
  [59, "< 1 min"],
  [3599, "59 min"],
  [7199, "1 h"],
  [4e6, "> 100 h"],
])("%d s are roughly %s", (seconds, text) => {
  expect(roughDuration(seconds)).toBe(text);
});

test.each([
  [0, "0:00.0"],
  [2.4, "0:02.4"],
  [59.9999999, "1:00.0"],
  [3661.25, "1:01:01.2"],
])("%d s with tenths is %s", (seconds, text) => {
  expect(clockTenths(seconds)).toBe(text);
});
