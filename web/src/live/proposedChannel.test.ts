import { expect, test } from "vitest";
import { numbersVerdict } from "./assess";
import { message, receivedImage, situation } from "./builders";
import { proposedChannel } from "./proposedChannel";

test("a proposal is shown with live figures only", () => {
  const right = { vertebra: "L3", side: "right", is_registered: true } as const;
  const newest = message({ proposed_channel: right });
  const at = (nowMs: number) => ({
    numbers: numbersVerdict(situation({ newest, numbers: receivedImage(960) }), nowMs),
    newest,
  });
  expect(proposedChannel(at(1000))).toEqual(right);
  // The image has become too old, and no newer one came.
  expect(proposedChannel(at(1200))).toBeNull();
  expect(proposedChannel({ ...at(1000), newest: message() })).toBeNull();
});
