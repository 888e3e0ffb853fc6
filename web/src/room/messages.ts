// Messages of the room, typed by the server's schema. The page's messages are defined in
// `server/api/supervision_messages.py` (`Said`).
import type {
  HoldMessage as Hold,
  PersonMessage as Person,
  SignableMessage as Signable,
  YouMessage as You,
  ConnectionState,
  RoomMessage,
  Shape,
} from "../api";

export type { ConnectionState, Hold, Person, RoomMessage, Shape, Signable, You };

export type Point = readonly [number, number];

/** The image on display when something was marked. */
export interface Moment {
  image_number: number;
  captured_at_s: number;
}

export type ClientMessage =
  | { next: true }
  | { point: { at_px: Point } & Moment }
  | { lift: true }
  | { draw: { key: number; shape: Shape; points_px: readonly Point[] } & Moment }
  | { extend: { key: number; points_px: readonly Point[] } }
  | { undo: true }
  | { clear: "own" | "all" };
