// Provides the room to the page. Without a provider (in a test, before a session) the room is empty.
import { createContext, use, useEffect, useMemo, useSyncExternalStore, type ReactNode } from "react";
import type { ViewName } from "../app/views";
import { Room, type RoomSnapshot } from "./room";

const RoomContext = createContext<Room | null>(null);
const ALONE: RoomSnapshot = {
  isConnected: false,
  firstMessage: "awaited",
  you: null,
  people: [],
  hold: null,
  fadesAfterS: null,
  signable: null,
};
const never = (): (() => void) => () => undefined;
const alone = (): RoomSnapshot => ALONE;

export function RoomProvider({ view, children }: { view: ViewName; children: ReactNode }): ReactNode {
  const room = useMemo(() => new Room(view), [view]);
  useEffect(() => room.start(), [room]);
  return <RoomContext value={room}>{children}</RoomContext>;
}

/** The room store, for canvases that paint without React. */
export function useRoom(): Room | null {
  return use(RoomContext);
}

/** Who is present, who asks to hold, and what is signed. */
export function useRoomSnapshot(): RoomSnapshot {
  const room = use(RoomContext);
  return useSyncExternalStore(room?.onSnapshot ?? never, room?.snapshot ?? alone);
}
