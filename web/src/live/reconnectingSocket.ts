// A WebSocket that reconnects after a loss, with increasing delay. Its users define the messages
// (`viewConnection.ts`, `room/roomConnection.ts`, `phone/phoneConnection.ts`).
import { waitBeforeMs } from "./backoff";

/** The part of a WebSocket that is used here; tests pass a fake. */
export interface WebSocketLike {
  onopen: (() => void) | null;
  onmessage: ((event: { data: unknown }) => void) | null;
  onclose: (() => void) | null;
  send(text: string): void;
  close(): void;
}

interface ReconnectingSocketOptions<S extends WebSocketLike> {
  open(): S;
  later(action: () => void, waitMs: number): void;
  /** The socket is open: the first message may be sent. */
  onOpen(socket: S): void;
  /** A message was received: call `markReceived()` if it is valid, `reconnect()` if not. */
  onData(data: unknown): void;
  onLost(): void;
}

/** Timeout for opening the socket. */
export const ANSWER_WITHIN_MS = 2000;

export class ReconnectingSocket<S extends WebSocketLike> {
  private current: S | null = null;
  private isOpen = false;
  private attempt = 0;
  private stopped = true;

  constructor(private readonly options: ReconnectingSocketOptions<S>) {}

  /** The current socket, open or still connecting; null between two attempts. */
  get socket(): S | null {
    return this.current;
  }

  /** The current socket once it is open, else null. */
  get openSocket(): S | null {
    return this.isOpen ? this.current : null;
  }

  /** Whether a valid message was received since the last loss. */
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

  /** A valid message was received: resets the reconnect delay. */
  markReceived(): void {
    this.attempt = 0;
  }

  /** Closes the current socket and opens a new one after the reconnect delay. */
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
