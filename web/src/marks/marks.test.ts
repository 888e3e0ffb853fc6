import { describe, expect, test } from "vitest";
import { message, snapshot } from "../live/builders";
import { Live } from "../live/live";
import type { ClientMessage } from "../room/messages";
import { DisplayedImage } from "./displayedImage";
import { MarksInput } from "./marksInput";
import { markSurfaceAt } from "./cutMarks";
import { bonePoint } from "./useBoneMarks";
import { isOnImage, onImage, onStage, placed } from "./place";

const MOMENT = { image_number: 7, captured_at_s: 4 };

describe("position of a mark", () => {
  test.each([
    ["the same shape", { width: 640, height: 360 }, [0, 0], [0.25, 0.25]],
    ["a wider stage", { width: 1000, height: 360 }, [0, 0], [180.25, 0.25]],
    ["a higher stage", { width: 640, height: 500 }, [1279, 719], [639.75, 429.75]],
  ] as const)("on %s", (_, stage, px, expected) => {
    const placement = placed({ width: 1280, height: 720 }, stage);
    if (placement === null) throw new Error("no placement");
    const [x, y] = onStage(px, placement);
    expect([x, y]).toEqual([...expected]);
    expect(onImage([x, y], placement)).toEqual([...px]);
  });

  test("beside the picture nothing is marked", () => {
    const placement = placed({ width: 1280, height: 720 }, { width: 1000, height: 360 });
    if (placement === null) throw new Error("no placement");
    expect(isOnImage([100, 100], placement)).toBe(false);
    expect(onImage([100, 100], placement)[0]).toBe(0);
    expect(placed({ width: 0, height: 0 }, { width: 10, height: 10 })).toBeNull();
  });
});

describe("a hand", () => {
  function hand(takes: () => boolean = () => true) {
    const messages: ClientMessage[] = [];
    const made = new MarksInput((one) => {
      if (!takes()) return false;
      messages.push(one);
      return true;
    });
    return { made, said: messages };
  }

  test("points no more often than is seen", () => {
    const { made, said: messages } = hand();
    for (let ms = 0; ms < 1000; ms += 5) made.point([ms, 1], MOMENT, ms);
    expect(messages.length).toBeLessThan(25);
    expect(messages[0]).toEqual({ point: { at: [0, 1], ...MOMENT } });
  });

  test("is sent at its final position", () => {
    const { made, said: messages } = hand();
    made.point([1, 1], MOMENT, 0);
    made.point([2, 2], MOMENT, 10);
    made.flush(40);
    expect(messages).toHaveLength(1);
    made.flush(45);
    made.flush(200);
    expect(messages.slice(1)).toEqual([{ point: { at: [2, 2], ...MOMENT } }]);
    made.down("pen", [0, 0], MOMENT, 300);
    made.flush(361);
    expect(messages).toHaveLength(3);
  });

  test("is shown here where others see it, for as long, and not if it was not sent", () => {
    let open = true;
    const { made } = hand(() => open);
    expect(made.pointerAt(0)).toBeNull();
    made.point([1, 1], MOMENT, 0);
    made.point([2, 2], MOMENT, 10);
    expect(made.pointerAt(20)?.at).toEqual([1, 1]);
    made.flush(50);
    expect(made.pointerAt(60)?.at).toEqual([2, 2]);
    expect(made.pointerAt(2049)).not.toBeNull();
    expect(made.pointerAt(2050)).toBeNull();
    made.point([3, 3], MOMENT, 3000);
    made.lift();
    expect(made.pointerAt(3001)).toBeNull();
    open = false;
    made.point([4, 4], MOMENT, 4000);
    expect(made.pointerAt(4001)).toBeNull();
  });

  test("sends a pen line in parts that add up", () => {
    const { made, said: messages } = hand();
    made.down("pen", [0, 0], MOMENT, 0);
    for (let n = 1; n <= 200; n += 1) made.move([n * 3, 0], n * 10);
    made.up(3000);
    const points = messages.flatMap((one) =>
      "draw" in one ? one.draw.points : "extend" in one ? one.extend.points : [],
    );
    expect(points).toHaveLength(201);
    expect(messages.filter((one) => "draw" in one)).toHaveLength(1);
    expect(Math.max(...messages.map((one) => JSON.stringify(one).length))).toBeLessThan(1024);
  });

  test("a line without end becomes several drawings, none too long", () => {
    const { made, said: messages } = hand();
    made.down("pen", [0, 0], MOMENT, 0);
    for (let n = 1; n <= 900; n += 1) made.move([n * 3, 0], n * 10);
    made.up(10_000);
    const lengths = new Map<number, number>();
    for (const one of messages) {
      const part = "draw" in one ? one.draw : "extend" in one ? one.extend : null;
      if (part) lengths.set(part.key, (lengths.get(part.key) ?? 0) + part.points.length);
    }
    expect([...lengths.values()].every((length) => length <= 400)).toBe(true);
    expect(lengths.size).toBe(3);
  });

  test("points that did not fit into a message are sent later", () => {
    let open = false;
    const { made, said: messages } = hand(() => open);
    made.down("pen", [0, 0], MOMENT, 0);
    made.move([10, 0], 100);
    open = true;
    made.move([20, 0], 200);
    expect(messages).toEqual([
      {
        draw: {
          key: 1,
          shape: "pen",
          points: [
            [0, 0],
            [10, 0],
            [20, 0],
          ],
          ...MOMENT,
        },
      },
    ]);
  });

  test("an arrow is sent when it is complete, and a slip is ignored", () => {
    const { made, said: messages } = hand();
    made.down("arrow", [0, 0], MOMENT, 0);
    made.move([50, 0], 10);
    made.move([60, 10], 20);
    expect(messages).toEqual([]);
    made.up(30);
    made.down("arrow", [0, 0], MOMENT, 40);
    made.up(50);
    expect(messages).toEqual([
      {
        draw: {
          key: 1,
          shape: "arrow",
          points: [
            [0, 0],
            [60, 10],
          ],
          ...MOMENT,
        },
      },
    ]);
    expect(made.own.map((one) => one.key)).toEqual([1]);
    made.settle(() => true, 100);
    expect(made.own).toEqual([]);
  });

  test("a click on the bone is a point on the axial plane through it", () => {
    const { made, said: messages } = hand();
    const point = bonePoint({ kind: "coaxial-bone-point", point_in_vertebra_mm: [1.234, -2, 1100.5] });
    if (point === null) throw new Error("no point");
    made.dot(markSurfaceAt(point, "ct-1", MOMENT), 0);
    const plane = {
      ct_id: "ct-1",
      origin_in_vertebra_mm: [1.23, -2, 1100.5],
      right_in_vertebra: [1, 0, 0],
      down_in_vertebra: [0, 1, 0],
    };
    expect(messages).toEqual([{ draw: { key: 1, shape: "pen", points: [[0, 0]], plane, ...MOMENT } }]);
  });

  test.each([null, "text", { kind: "coaxial-scene" }, { kind: "coaxial-bone-point" }])(
    "another message of the scene (%j) is no click",
    (data) => {
      expect(bonePoint(data)).toBeNull();
    },
  );

  test("drawings that are never confirmed are dropped", () => {
    const { made } = hand(() => false);
    made.down("circle", [0, 0], MOMENT, 0);
    made.move([50, 0], 10);
    made.up(30);
    made.settle(() => false, 3000);
    expect(made.own).toHaveLength(1);
    made.settle(() => false, 3031);
    expect(made.own).toEqual([]);
  });
});

test("a mark belongs to the picture that is marked, not to the newer figures beside it", async () => {
  const live = new Live(() => 1000);
  live.setDraw(() => Promise.resolve(true));
  live.setLink("open");
  const of = (image: number) => snapshot({ image_number: image, captured_at_s: image / 10 });
  await live.receive({ message: message({ sequence: 5, snapshot: of(5) }), jpeg: new Uint8Array([1]) });
  live.receiveMessage(message({ sequence: 8, snapshot: of(8) }));
  await live.receive({ message: message({ sequence: 7, snapshot: of(7) }), jpeg: new Uint8Array([1]) });
  const displayed = new DisplayedImage();
  displayed.update(live.update());
  expect(displayed.moment).toEqual({ image_number: 7, captured_at_s: 0.7 });
  live.setHidden(true);
  displayed.update(live.update());
  expect(displayed.moment).toBeNull();
});
