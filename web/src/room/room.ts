// State of the room on this page: one connection and one store. Canvases read marks directly; texts go through React.
import type { ViewName } from "../app/views";
import { firstMessageAt, type FirstMessage, type FirstMessageWait } from "../live/firstMessage";
import { socketAddress } from "../live/socketAddress";
import { pageLanguage } from "../texts/pageLanguage";
import type { Hold, Person, RoomMessage, ClientMessage, Signable, You } from "./messages";
import { RoomConnection, type RoomSocket } from "./roomConnection";
import { afterMessage, stateAt, NOBODY, type RoomState } from "./roomState";

/** State that texts depend on; a new object only when part of it changed. */
export interface RoomSnapshot {
  isConnected: boolean;
  /** Lives as long as the page. */
  firstMessage: FirstMessage;
  you: You | null;
  people: readonly Person[];
  hold: Hold | null;
  fadesAfterS: number | null;
  signable: readonly Signable[] | null;
}

const CHECK_EVERY_MS = 500;

export class Room {
  private state: RoomState = NOBODY;
  private published: RoomSnapshot = { isConnected: false, firstMessage: "awaited", ...snapshotOf(NOBODY) };
  private readonly wait: FirstMessageWait = { everReceived: false, waitingSinceMs: performance.now() };
  private readonly listeners = new Set<() => void>();
  private readonly painters = new Set<() => void>();
  private readonly connection: RoomConnection;

  constructor(view: ViewName) {
    this.connection = new RoomConnection({
      open: () => new WebSocket(socketAddress(`/ws/room?view=${view}&lang=${pageLanguage()}`)) as RoomSocket,
      later: (action, waitMs) => {
        setTimeout(action, waitMs);
      },
      now: () => performance.now(),
      onMessage: (message) => {
        this.receive(message);
      },
      onConnection: (isConnected) => {
        if (!isConnected) this.forget();
      },
    });
  }

  start(): () => void {
    this.connection.start();
    const timer = setInterval(() => {
      this.connection.checkTimeout();
      this.publish({ ...this.published, firstMessage: firstMessageAt(this.wait, performance.now()) });
    }, CHECK_EVERY_MS);
    return () => {
      clearInterval(timer);
      this.connection.stop();
    };
  }

  /** False if there is no connection. */
  send(message: ClientMessage): boolean {
    return this.connection.send(message);
  }

  /** Current marks, without expired ones. */
  now(): RoomState {
    this.state = stateAt(this.state, performance.now());
    return this.state;
  }

  snapshot = (): RoomSnapshot => this.published;

  onSnapshot = (listener: () => void): (() => void) => {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  };

  /** Called when pointers or drawings may have changed. */
  onMarks(painter: () => void): () => void {
    this.painters.add(painter);
    return () => this.painters.delete(painter);
  }

  private receive(message: RoomMessage): void {
    this.wait.everReceived = true;
    this.state = afterMessage(this.state, message, performance.now());
    this.publish({ isConnected: true, firstMessage: "received", ...snapshotOf(this.state) });
    for (const paint of this.painters) paint();
  }

  private forget(): void {
    this.state = NOBODY;
    this.publish({ isConnected: false, firstMessage: this.published.firstMessage, ...snapshotOf(NOBODY) });
    for (const paint of this.painters) paint();
  }

  private publish(next: RoomSnapshot): void {
    if (JSON.stringify(next) === JSON.stringify(this.published)) return;
    this.published = next;
    for (const listener of this.listeners) listener();
  }
}

function snapshotOf({
  you,
  people,
  hold,
  fadesAfterS,
  signable,
}: RoomState): Omit<RoomSnapshot, "isConnected" | "firstMessage"> {
  return { you, people, hold, fadesAfterS, signable };
}
