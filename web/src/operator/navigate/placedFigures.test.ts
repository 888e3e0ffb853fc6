import { expect, test } from "vitest";
import type { PlacedFigureMessage, PlacementMessage } from "../../api";
import { de } from "../../texts/de";
import { en } from "../../texts/en";
import { placedFigures } from "./placedFigures";

type Placement = PlacementMessage;

const figure = (value: number | null): PlacedFigureMessage => ({
  value,
  limit: null,
  error_95: null,
  status: "within",
});

function placement(changes: Partial<Placement> = {}): Placement {
  return {
    document_id: "d",
    placed_at: "2026-11-27T10:00:00.000Z",
    placed_by: "ito",
    out_of_date: null,
    tool: "drill",
    image_number: 7,
    screw: { diameter_mm: 6.5, length_mm: 45 },
    verdict: "on_path",
    wall: "medial",
    clearance_mm: -0.4,
    grade: "B",
    figures: { entry: figure(0.8), angle: figure(2), error: figure(0.61) },
    ...changes,
  };
}

test("figures as they were displayed, with the wall and its grade", () => {
  expect(placedFigures(placement(), en)).toBe(
    "entry 0.8 mm · angle 2.0° · 95 % error ±0.61 mm · nearest wall medial -0.4 mm · Gertzbein-Robbins B",
  );
  const short = placement({ figures: { depth: { ...figure(25), limit: 54.8 } } });
  expect(placedFigures(short, en)).toMatch(/^drill at 25.0 of 54.8 mm · /);
  expect(placedFigures(placement(), de)).toContain("nächste Wand medial -0.4 mm");
});

test("what is not known is omitted and not zero", () => {
  const unknown = placement({
    wall: null,
    clearance_mm: null,
    grade: null,
    figures: { entry: figure(null) },
  });
  expect(placedFigures(unknown, en)).toBe("");
});
