// The connection to /ws/room: requests the next message after each one; reconnects (`live/reconnectingSocket.ts`).
import { ReconnectingSocket, type WebSocketLike } from "../live/reconnectingSocket";
import type { RoomMessage, ClientMessage } from "./messages";

export interface RoomSocket extends WebSocketLike {
  readonly bufferedAmount: number;
}

interface RoomConnectionOptions {
  open(): RoomSocket;
  later(action: () => void, waitMs: number): void;
  now(): number;
  onMessage(message: RoomMessage): void;
  /** Called with true after a valid message, with false after a loss. */
  onConnection(isConnected: boolean): void;
}

/** The server sends a message every second. */
export const SILENT_AFTER_MS = 3000;
/** With more unsent bytes than this, marks are dropped: on a slow connection they would arrive too late. */
const MAX_UNSENT_BYTES = 4096;
const NEXT = JSON.stringify({ next: true } satisfies ClientMessage);

export class RoomConnection {
  private readonly socket: ReconnectingSocket<RoomSocket>;
  private lastReceivedAtMs = 0;

  constructor(private readonly options: RoomConnectionOptions) {
    this.socket = new ReconnectingSocket<RoomSocket>({
      open: () => {
        this.lastReceivedAtMs = options.now();
        return options.open();
      },
      later: (action, waitMs) => {
        options.later(action, waitMs);
      },
      onOpen: (socket) => {
        socket.send(NEXT);
      },
      onData: (data) => {
        this.receive(data);
      },
      onLost: () => {
        options.onConnection(false);
      },
    });
  }

  start(): void {
    this.socket.start();
  }

  stop(): void {
    this.socket.stop();
  }

  /** Call periodically: reconnects when nothing was received for `SILENT_AFTER_MS`. */
  checkTimeout(): void {
    if (this.socket.socket !== null && this.options.now() - this.lastReceivedAtMs > SILENT_AFTER_MS)
      this.socket.reconnect();
  }

  /** Returns false if the message was not sent: no connection, or too much is unsent. */
  send(message: ClientMessage): boolean {
    const { socket } = this.socket;
    if (socket === null || !this.socket.hasReceived || socket.bufferedAmount > MAX_UNSENT_BYTES) return false;
    socket.send(JSON.stringify(message));
    return true;
  }

  private receive(data: unknown): void {
    let message: RoomMessage;
    try {
      message = JSON.parse(String(data)) as RoomMessage;
    } catch {
      this.socket.reconnect();
      return;
    }
    this.lastReceivedAtMs = this.options.now();
    this.socket.markReceived();
    this.options.onConnection(true);
    this.options.onMessage(message);
    // The listener may have closed the connection.
    this.socket.openSocket?.send(NEXT);
  }
}
