import { describe, expect, test } from "vitest";
import { snapshot } from "../../live/builders";
import { comparisonOf } from "./comparison";
import type { RecordedInstant } from "./useShownInstant";

type Tool = RecordedInstant["snapshot"]["tools"][number];
type Assessment = Extract<Tool["assessment"], { kind: "assessment" }>;

/** An instant with this offset at the entry and its error; null without figures. */
function instant(atS: number, entry: number | null, error: number | null = 0.2): RecordedInstant {
  const built = snapshot();
  const [tool] = built.tools;
  if (tool?.assessment.kind !== "assessment") throw new Error("the builder has figures");
  const known: Assessment = tool.assessment;
  const figure = { value: entry, limit: 2, error_95: error, status: "within" as const };
  const assessment: Tool["assessment"] =
    entry === null
      ? { kind: "absent", reason: "MARKER_UNSEEN" }
      : { ...known, figures: { ...known.figures, entry: figure } };
  const alone = { ...tool, assessment };
  return {
    number: 0,
    at_s: atS,
    alarms: null,
    snapshot: { ...built, tools: [alone], displayed_tool: entry === null ? null : alone.name },
  };
}

describe("two instants", () => {
  test("differ by the displayed digits, with both errors", () => {
    const { reason, figures } = comparisonOf(instant(3, 1.2), instant(8, 0.9, 0.3), 5);
    expect(reason).toBeNull();
    expect(figures.entry.difference?.value).toBeCloseTo(-0.3);
    expect(figures.entry.difference?.error95).toBeCloseTo(0.5);
  });

  test("of clearances to different walls have none, but the other figures do", () => {
    const other = instant(8, 0.9);
    const [tool] = other.snapshot.tools;
    if (tool?.assessment.kind !== "assessment") throw new Error("the instant has figures");
    const against = tool.assessment.against === "channel" ? "bone" : "channel";
    const tools = [{ ...tool, assessment: { ...tool.assessment, against } as const }];
    const { reason, figures } = comparisonOf(
      instant(3, 1.2),
      { ...other, snapshot: { ...other.snapshot, tools } },
      5,
    );
    expect(reason).toBe("other-wall");
    expect(figures.wall.first).not.toBeNull();
    expect(figures.wall.difference).toBeNull();
    expect(figures.entry.difference?.value).toBeCloseTo(-0.3);
  });

  test.each([
    ["first-absent", instant(3, null), instant(8, 0.9)],
    ["second-absent", instant(3, 1.2), instant(8, null)],
    ["apart", instant(3, 1.2), instant(8.2, 0.9)],
  ] as const)("have no difference: %s", (reason, first, second) => {
    const found = comparisonOf(first, second, 5);
    expect(found.reason).toBe(reason);
    expect(Object.values(found.figures).map(({ difference }) => difference)).toEqual([
      null,
      null,
      null,
      null,
    ]);
  });

  test("keep their own figures where there is no difference", () => {
    const { figures } = comparisonOf(instant(3, 1.2), instant(8.2, 0.9), 5);
    expect([figures.entry.first?.value, figures.entry.second?.value]).toEqual([1.2, 0.9]);
  });

  test("of a tenth of a second apart are one instant", () => {
    expect(comparisonOf(instant(3, 1.2), instant(8.1, 0.9), 5).reason).toBeNull();
  });

  test("without a known error have a difference without one", () => {
    expect(
      comparisonOf(instant(3, 1.2, null), instant(8, 0.9), 5).figures.entry.difference?.error95,
    ).toBeNull();
  });
});
