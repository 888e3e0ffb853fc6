// Messages of the room, typed by the server's schema. The page's messages are defined in
// `server/api/supervision_messages.py` (`Said`).
import type { components } from "../schema";

type Schemas = components["schemas"];

export type RoomMessage = Schemas["RoomMessage"];
export type Person = Schemas["PersonMessage"];
export type Hold = Schemas["HoldMessage"];
export type You = Schemas["YouMessage"];
export type Signable = Schemas["SignableMessage"];
export type Shape = Schemas["Shape"];
export type ConnectionState = Schemas["ConnectionState"];

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
