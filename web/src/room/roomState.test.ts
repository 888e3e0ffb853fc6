import { describe, expect, test } from "vitest";
import type { RoomMessage } from "./messages";
import { afterMessage, stateAt, NOBODY } from "./roomState";

const QUIET: RoomMessage = {
  you: { seat: 3, name: "Guest", role: "viewer" },
  fades_after_s: 20,
  people: null,
  pointers: [],
  drawings: [],
  grown: [],
  hold: { requested_by: [], since: null, is_yours: false },
  signable: null,
};
const SATO = { name: "Dr Sato", role: "supervisor", seat: 1, image_number: 7, captured_at_s: 4 } as const;

function grown(from_point: number, points: number[][], key = "1-1"): RoomMessage["grown"][number] {
  return { ...SATO, key, is_yours: false, shape: "pen", left_s: 12, from_point, points, plane: null };
}

describe("what a page knows of the room", () => {
  test("people and signatures stay until new ones are sent", () => {
    const people = [
      { name: "A", role: "viewer", views: [], since: "", line: "good", is_you: true },
    ] satisfies RoomMessage["people"];
    const first = afterMessage(NOBODY, { ...QUIET, people, signable: [] }, 0);
    const second = afterMessage(first, QUIET, 10);
    expect(second.people).toEqual(people);
    expect(second.signable).toEqual([]);
  });

  test("a drawing grows point by point, and disappears when it is no longer listed", () => {
    const first = afterMessage(
      NOBODY,
      {
        ...QUIET,
        drawings: ["1-1"],
        grown: [
          grown(0, [
            [1, 2],
            [3, 4],
          ]),
        ],
      },
      1000,
    );
    const second = afterMessage(first, { ...QUIET, drawings: ["1-1"], grown: [grown(2, [[5, 6]])] }, 1100);
    expect(second.marks.map((one) => one.points)).toEqual([
      [
        [1, 2],
        [3, 4],
        [5, 6],
      ],
    ]);
    // It lasts 20 s, of which 8 s have passed.
    expect(second.marks[0]?.goesAtMs).toBe(13_100);
    expect(second.marks[0]?.madeAtMs).toBe(-6900);
    expect(afterMessage(second, QUIET, 1200).marks).toEqual([]);
  });

  test("half a drawing is not shown as a whole one", () => {
    const state = afterMessage(NOBODY, { ...QUIET, drawings: ["1-1"], grown: [grown(2, [[5, 6]])] }, 0);
    expect(state.marks).toEqual([]);
  });

  test("expired marks disappear without a message from the server", () => {
    const pointer = { ...SATO, at: [10, 20], plane: null, still_ms: 500 };
    const message = {
      ...QUIET,
      pointers: [pointer],
      drawings: ["1-1"],
      grown: [grown(0, [[1, 2]])],
    } satisfies RoomMessage;
    const state = afterMessage(NOBODY, message, 1000);
    expect(stateAt(state, 2499)).toBe(state);
    expect(stateAt(state, 2500).pointers).toEqual([]);
    expect(stateAt(state, 12_999).marks).toHaveLength(1);
    expect(stateAt(state, 13_000).marks).toEqual([]);
  });
});
