import { expect, test } from "vitest";
import { numbersVerdict, type NumbersVerdict } from "../live/assess";
import { judgement, receivedImage, situation, snapshot } from "../live/builders";
import { assessment } from "../live/figureBuilders";
import type { SnapshotMessage } from "../live/messages";
import { displayedDrill, drillOf } from "./drill";

/** A camera behind (LPS +y) a prone patient: its x points to the patient's right, its y to the feet. */
const CAMERA_FROM_VERTEBRA = {
  rotation: [
    [-1, 0, 0],
    [0, 0, -1],
    [0, -1, 0],
  ],
  translation_mm: [5, -10, 400],
};

/** A drill pointing away from the camera, its tip at (-14, 3, 380) in camera coordinates. */
function seen(): SnapshotMessage {
  const base = snapshot();
  const [tool] = base.tools;
  if (tool === undefined) throw new Error("the builder has no tool");
  return {
    ...base,
    vertebra: { kind: "vertebra", camera_from_vertebra: CAMERA_FROM_VERTEBRA, covariance: [] },
    tools: [
      {
        ...tool,
        pose: {
          kind: "tool",
          camera_from_tool: {
            rotation: [
              [1, 0, 0],
              [0, 1, 0],
              [0, 0, 1],
            ],
            translation_mm: [-14, 3, 380],
          },
          tip_sd_mm: 0.1,
          lag_ms: 0,
        },
        judgement: judgement(),
      },
    ],
  };
}

test("the drill is placed in the vertebra by both poses of the same message", () => {
  const drill = drillOf(seen(), "drill");
  // From the vertebra's origin in the camera: (-19, 13, -20), i.e. 19 left, 13 to the feet, 20 back.
  expect(drill?.pose.tip.map((one) => one + 0)).toEqual([19, 20, -13]);
  expect(drill?.pose.axis.map((one) => one + 0)).toEqual([0, -1, 0]);
  expect(drill?.radiusMm).toBe(seen().tools[0]?.along?.drill_radius_mm);
  expect(drill?.nearest).toEqual([0, 0, 0]);
});

test("a message without a pose of tool or vertebra, or without figures, places no drill", () => {
  const whole = seen();
  const absent = { kind: "absent", reason: "MARKER_UNSEEN" } as const;
  const [tool] = whole.tools;
  if (tool === undefined) throw new Error("the builder has no tool");
  expect(drillOf({ ...whole, vertebra: absent }, "drill")).toBeNull();
  expect(drillOf({ ...whole, tools: [{ ...tool, pose: absent }] }, "drill")).toBeNull();
  expect(drillOf({ ...whole, tools: [{ ...tool, along: null }] }, "drill")).toBeNull();
  expect(drillOf(whole, "awl")).toBeNull();
});

test("the displayed drill belongs to the image of the displayed figures; none without figures", () => {
  const first = seen();
  const tools = first.tools.map((one) => ({ ...one, assessment: assessment() }));
  const numbers = (drilled: SnapshotMessage): NumbersVerdict =>
    numbersVerdict(situation({ numbers: receivedImage(960, drilled) }), 1000);
  expect(displayedDrill(numbers({ ...first, tools }))?.pose.tip.map((one) => one + 0)).toEqual([19, 20, -13]);
  const moved = {
    ...first,
    tools,
    vertebra: {
      ...first.vertebra,
      camera_from_vertebra: { ...CAMERA_FROM_VERTEBRA, translation_mm: [6, -10, 400] },
    },
  } as SnapshotMessage;
  expect(displayedDrill(numbers(moved))?.pose.tip.map((one) => one + 0)).toEqual([20, 20, -13]);
  expect(displayedDrill(numbers({ ...first, tools, displayed_tool: null }))).toBeNull();
});
