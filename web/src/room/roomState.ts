// State of the room. Pure: takes a message and a time, returns the next state.
import type { CutPlane, Hold, Person, Point, RoomMessage, Shape, Signable, You } from "./messages";

/** Same as on the server: a pointer that stops moving expires. */
export const POINTER_GOES_AFTER_MS = 2000;

export interface Pointer {
  seat: number;
  name: string;
  at: Point;
  /** Null on the video. */
  plane: CutPlane | null;
  goesAtMs: number;
}

export interface Mark {
  key: string;
  seat: number;
  name: string;
  yours: boolean;
  shape: Shape;
  points: readonly Point[];
  /** Null on the video. */
  plane: CutPlane | null;
  madeAtMs: number;
  goesAtMs: number;
}

export interface RoomState {
  you: You | null;
  people: readonly Person[];
  pointers: readonly Pointer[];
  marks: readonly Mark[];
  hold: Hold | null;
  /** Lifetime of a drawing, from its image; null before the first message. */
  fadesAfterS: number | null;
  /** Null if nothing is stored, or before the first message. */
  signable: readonly Signable[] | null;
}

export const NOBODY: RoomState = {
  you: null,
  people: [],
  pointers: [],
  marks: [],
  hold: null,
  fadesAfterS: null,
  signable: null,
};

export function afterMessage(state: RoomState, message: RoomMessage, nowMs: number): RoomState {
  return {
    you: message.you,
    people: message.people ?? state.people,
    pointers: message.pointers.map((one) => ({
      seat: one.seat,
      name: one.name,
      at: pointOf(one.at),
      plane: one.plane,
      goesAtMs: nowMs + POINTER_GOES_AFTER_MS - one.still_ms,
    })),
    marks: marksAfter(state.marks, message, nowMs),
    hold: message.hold,
    fadesAfterS: message.fades_after_s,
    signable: message.signable ?? state.signable,
  };
}

/** Removes what has expired; returns the same object if nothing has. */
export function stateAt(state: RoomState, nowMs: number): RoomState {
  const pointers = state.pointers.filter((one) => one.goesAtMs > nowMs);
  const marks = state.marks.filter((one) => one.goesAtMs > nowMs);
  if (pointers.length === state.pointers.length && marks.length === state.marks.length) return state;
  return { ...state, pointers, marks };
}

function marksAfter(marks: readonly Mark[], message: RoomMessage, nowMs: number): Mark[] {
  const known = new Map(marks.map((one) => [one.key, one]));
  for (const one of message.grown) {
    const before = known.get(one.key)?.points ?? [];
    // A part that continues points which are not here belongs to another connection; it cannot be drawn completely.
    if (one.from_point > before.length) continue;
    const goesAtMs = nowMs + one.left_s * 1000;
    known.set(one.key, {
      key: one.key,
      seat: one.seat,
      name: one.name,
      yours: one.is_yours,
      shape: one.shape,
      points: [...before.slice(0, one.from_point), ...one.points.map(pointOf)],
      plane: one.plane,
      madeAtMs: goesAtMs - message.fades_after_s * 1000,
      goesAtMs,
    });
  }
  return message.drawings.flatMap((key) => known.get(key) ?? []);
}

function pointOf(sent: readonly number[]): Point {
  return [sent[0] ?? NaN, sent[1] ?? NaN];
}
