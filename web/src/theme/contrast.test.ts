// Contrast of the themes' colours as in WCAG 2.2: 4.5 for text (AA), 7 for figures and headlines (AAA), 3 for edges of
// controls that are focused or chosen.
import { expect, test } from "vitest";
import SHEET from "./tokens.css?raw";

/** Colours of the rule that begins with this selector. */
function tokensOf(selector: string): Map<string, string> {
  const start = SHEET.indexOf(`\n${selector}`);
  const rule = SHEET.slice(SHEET.indexOf("{", start), SHEET.indexOf("}", start));
  return new Map(
    [...rule.matchAll(/(--[\w-]+): (#[0-9a-f]+);/g)].map(([, name = "", hex = ""]) => [name, hex]),
  );
}

const FILLS = tokensOf(":root {");
const THEMES = {
  dark: new Map([...FILLS, ...tokensOf(":root,")]),
  light: new Map([...FILLS, ...tokensOf('[data-theme="light"] {')]),
};

function luminance(hex: string): number {
  const digits = hex.length === 4 ? hex.replace(/[0-9a-f]/g, "$&$&") : hex;
  const [red = 0, green = 0, blue = 0] = (digits.match(/[0-9a-f]{2}/g) ?? []).map((two) => {
    const value = parseInt(two, 16) / 255;
    return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
  });
  return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
}

function contrast(one: string, other: string): number {
  const [dark = 0, light = 0] = [luminance(one), luminance(other)].toSorted((a, b) => a - b);
  return (light + 0.05) / (dark + 0.05);
}

test("the contrast of black and white is 21, as WCAG defines it", () => {
  expect(contrast("#fff", "#000000")).toBeCloseTo(21);
  expect(contrast("#777777", "#ffffff")).toBeCloseTo(4.48, 2);
});

const FIGURES: readonly (readonly [string, string])[] = [
  ...["--ink", "--ink-soft", "--good", "--medium", "--high", "--low"].map((ink) => [ink, "--panel"] as const),
  ["--medium", "--caution-ground"],
  ["--high", "--danger-ground"],
  ["--ink", "--caution-ground"],
  ["--ink", "--danger-ground"],
];
const TEXT: readonly (readonly [string, string])[] = [
  ...["--ground", "--cover", "--selected", "--well"].flatMap((ground) =>
    ["--ink", "--ink-soft", "--good", "--medium", "--low"].map((ink) => [ink, ground] as const),
  ),
  ["--ink-soft", "--caution-ground"],
  ["--ink-soft", "--danger-ground"],
  ["--on-low", "--low"],
  ["--on-fill", "--medium-fill"],
  ["--on-fill", "--high-fill"],
  ["--on-fill", "--low-fill"],
];
const EDGES: readonly (readonly [string, string])[] = [
  ["--low", "--ground"],
  ["--low", "--panel"],
  ["--good", "--track"],
  ["--medium", "--track"],
];

for (const [name, tokens] of Object.entries(THEMES)) {
  test.each([
    ...FIGURES.map((pair) => [...pair, 7] as const),
    ...TEXT.map((pair) => [...pair, 4.5] as const),
    ...EDGES.map((pair) => [...pair, 3] as const),
  ])(`${name}: %s on %s has a contrast of %d`, (ink, ground, min) => {
    expect(contrast(tokens.get(ink) ?? "", tokens.get(ground) ?? "")).toBeGreaterThanOrEqual(min);
  });
}

test("every colour of one theme is in the other, so that none is inherited by accident", () => {
  const own = (tokens: Map<string, string>): string[] => [...tokens.keys()].toSorted();
  expect(own(THEMES.light)).toEqual(own(THEMES.dark));
});
