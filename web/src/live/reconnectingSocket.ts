// A line to the server that is kept: opened, taken anew after a loss with growing patience, and let go.
// What is said on it is the business of who keeps it (`viewConnection.ts`, `room/roomConnection.ts`).
import { waitBeforeMs } from "./backoff";

/** What is used of a WebSocket; tests bring their own. */
export interface WebSocketLike {
  onopen: (() => void) | null;
  onmessage: ((event: { data: unknown }) => void) | null;
  onclose: (() => void) | null;
  send(text: string): void;
  close(): void;
}

export interface ReconnectingSocketOptions<S extends WebSocketLike> {
  open(): S;
  later(action: () => void, waitMs: number): void;
  /** It stands: the first word may be said. */
  onOpen(socket: S): void;
  /** Something came; who understands it says `heard()`, who cannot, `lose()`: a new line starts clean. */
  onData(data: unknown): void;
  onLost(): void;
}

/** A server that takes the call but never answers is left after this long. */
export const ANSWER_WITHIN_MS = 2000;

export class ReconnectingSocket<S extends WebSocketLike> {
  private current: S | null = null;
  private isOpen = false;
  private attempt = 0;
  private stopped = true;

  constructor(private readonly options: ReconnectingSocketOptions<S>) {}

  /** The line that was opened, whether or not it stands yet; null between two of them. */
  get socket(): S | null {
    return this.current;
  }

  /** The same, once it stands. */
  get openSocket(): S | null {
    return this.isOpen ? this.current : null;
  }

  /** Whether something was understood since the last loss. */
  get hasReceived(): boolean {
    return this.current !== null && this.attempt === 0;
  }

  start(): void {
    this.stopped = false;
    this.connect();
  }

  stop(): void {
    this.stopped = true;
    this.release();
  }

  /** What came was understood: after the next loss the first wait is the shortest again. */
  markReceived(): void {
    this.attempt = 0;
  }

  /** Give this line up, and take a new one after the wait that is due. */
  reconnect(): void {
    if (this.stopped) return;
    this.release();
    this.options.onLost();
    const waitMs = waitBeforeMs(this.attempt);
    this.attempt += 1;
    this.options.later(() => {
      if (this.current === null) this.connect();
    }, waitMs);
  }

  private connect(): void {
    if (this.stopped) return;
    const socket = this.options.open();
    this.current = socket;
    socket.onopen = () => {
      this.isOpen = true;
      this.options.onOpen(socket);
    };
    socket.onmessage = ({ data }) => {
      this.options.onData(data);
    };
    socket.onclose = () => {
      this.reconnect();
    };
    this.options.later(() => {
      if (!this.isOpen && this.current === socket) this.reconnect();
    }, ANSWER_WITHIN_MS);
  }

  private release(): void {
    const socket = this.current;
    this.current = null;
    this.isOpen = false;
    if (socket === null) return;
    socket.onopen = socket.onmessage = socket.onclose = null;
    socket.close();
  }
}
