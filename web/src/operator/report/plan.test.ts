import { expect, test } from "vitest";
import { channelsIn } from "./plan";

test("a channel with its screw, its length from entry to end", () => {
  const channel = { entry_in_vertebra_mm: [0, 0, 0], target_in_vertebra_mm: [3, -4, 12], radius_mm: 2.5 };
  const content = {
    vertebrae: [
      {
        name: "L3",
        channels: [
          { side: "left", channel, by_hand: true, screws: [{ diameter_mm: 6.5, length_mm: 45 }] },
          { side: "right", channel: {}, screws: [] },
        ],
      },
      { name: "L4" },
    ],
  };
  expect(channelsIn(content)).toEqual([
    {
      vertebra: "L3",
      side: "left",
      diameterMm: 5,
      lengthMm: 13,
      byHand: true,
      screw: { diameterMm: 6.5, lengthMm: 45 },
    },
    { vertebra: "L3", side: "right", diameterMm: null, lengthMm: null, byHand: false, screw: null },
  ]);
});

test("a document that is not a plan has no channels", () => {
  expect(channelsIn({ vertebrae: "none" })).toEqual([]);
});
