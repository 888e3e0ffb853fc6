import { expect, test } from "vitest";
import { Rejection } from "../../../rest/client";
import { applyMatrix, translateOverlay, placeOf, type Overlay } from "./overlay";
import { OverlayController, type OverlayDrawing } from "./overlayController";

const RULER: Overlay = { shift_px: [640, 360], rotation_deg: 0, scale_px_per_mm: 3, fade_ratio: 0.5 };

function laid(overlay: Overlay): OverlayDrawing {
  return { vertebra: "L3", image_number: 1, overlay, slice: null, needles: [], directions: [], numbers: {} };
}

/** A server that answers on command. */
function slow(): {
  requests: (Overlay | null)[];
  ask: (overlay: Overlay | null) => Promise<OverlayDrawing>;
  answer: () => Promise<void>;
} {
  const requests: (Overlay | null)[] = [];
  const waiting: (() => void)[] = [];
  return {
    requests,
    ask: (overlay) => {
      requests.push(overlay);
      return new Promise((resolve) => {
        waiting.push(() => {
          resolve(laid(overlay ?? RULER));
        });
      });
    },
    answer: async () => {
      waiting.shift()?.();
      await new Promise((resolve) => setTimeout(resolve));
    },
  };
}

test("the slice begins where the ruler has it, and follows the hand before the server answers", async () => {
  const server = slow();
  const controller = new OverlayController(server.ask);
  controller.start();
  await server.answer();
  expect(controller.state()).toMatchObject({ hand: RULER, settled: true });
  controller.change((hand) => translateOverlay(hand, [10, 0]));
  expect(applyMatrix(controller.sinceAnswer ?? [], placeOf(RULER))).toEqual([650, 360]);
});

test("one question is on its way at a time, and the last place of the hand is always asked for", async () => {
  const server = slow();
  const controller = new OverlayController(server.ask);
  controller.start();
  await server.answer();
  for (let step = 0; step < 5; step += 1) controller.change((hand) => translateOverlay(hand, [1, 0]));
  expect(server.requests.map((one) => one?.shift_px[0])).toEqual([undefined, 641]);
  await server.answer();
  expect(controller.state().settled).toBe(false);
  expect(server.requests.at(-1)?.shift_px).toEqual([645, 360]);
  await server.answer();
  expect(controller.state().settled).toBe(true);
  expect(server.requests).toHaveLength(3);
});

test("what a hand did is undone as a whole, and so is the way back to the ruler", async () => {
  const server = slow();
  const controller = new OverlayController(server.ask);
  controller.start();
  await server.answer();
  controller.begin();
  controller.change((hand) => translateOverlay(hand, [1, 0]));
  controller.change((hand) => translateOverlay(hand, [1, 0]));
  controller.undo();
  expect(controller.newest?.hand).toEqual(RULER);
});

test("a rejection keeps the server's last answer and ends the requests", async () => {
  const rejection = new Rejection({
    code: "NO_PICTURE",
    message: "no",
    remedy: "Wait.",
    context: {},
    language: "en",
  } as const);
  let count = 0;
  const controller = new OverlayController((overlay) => {
    count += 1;
    return count === 1 ? Promise.resolve(laid(overlay ?? RULER)) : Promise.reject(rejection);
  });
  controller.start();
  await new Promise((resolve) => setTimeout(resolve));
  controller.step((hand) => translateOverlay(hand, [5, 0]));
  await new Promise((resolve) => setTimeout(resolve));
  expect(controller.state()).toMatchObject({ rejection, settled: false, laid: laid(RULER) });
  expect(count).toBe(2);
});
