// The room's messages, with the types of the server's schema. What a page says has its home in
// `server/api/supervision_messages.py`, as `Said`.
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

/** The image that stood on this page while something was marked on it. */
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
