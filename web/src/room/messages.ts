// Messages of the room, typed by the server's schema. The page's messages are defined in
// `server/api/supervision_messages.py` (`Said`).
import type {
  CutPlaneMessage as CutPlane,
  HoldMessage as Hold,
  PersonMessage as Person,
  SignableMessage as Signable,
  YouMessage as You,
  ConnectionState,
  RoomMessage,
  Shape,
} from "../api";

export type { ConnectionState, CutPlane, Hold, Person, RoomMessage, Shape, Signable, You };

/** x, y on what is marked: in pixels of the full-size image, or in mm on the plane of a cut. */
export type Point = readonly [number, number];

/** The image on display when something was marked. */
export interface Moment {
  image_number: number;
  captured_at_s: number;
}

/** What a mark is made on: the video image of a moment, or with a plane a cut that was on display with it. */
export interface MarkSurface extends Moment {
  plane?: CutPlane;
}

export type ClientMessage =
  | { next: true }
  | { point: { at: Point } & MarkSurface }
  | { lift: true }
  | { draw: { key: number; shape: Shape; points: readonly Point[] } & MarkSurface }
  | { extend: { key: number; points: readonly Point[] } }
  | { undo: true }
  | { clear: "own" | "all" };
