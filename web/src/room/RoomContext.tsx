// The room for everything on this page; outside it (in a test, before a session) there is nobody.
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

/** The room itself, for what is painted and said. */
export function useRoom(): Room | null {
  return use(RoomContext);
}

/** Who is here, who asks to hold, what is signed. */
export function useRoomSnapshot(): RoomSnapshot {
  const room = use(RoomContext);
  return useSyncExternalStore(room?.onSnapshot ?? never, room?.snapshot ?? alone);
}
