// The line to /ws/room: opens, asks for the next message when one is dealt with, and comes back after a loss.
import { waitBeforeMs } from "../live/backoff";
import type { RoomMessage, Said } from "./messages";

export interface RoomSocket {
  onopen: (() => void) | null;
  onmessage: ((event: { data: unknown }) => void) | null;
  onclose: (() => void) | null;
  readonly bufferedAmount: number;
  send(text: string): void;
  close(): void;
}

export interface RoomDoors {
  open(): RoomSocket;
  later(action: () => void, waitMs: number): void;
  now(): number;
  onMessage(message: RoomMessage): void;
  /** It stands and has spoken, or it is gone. */
  onLine(stands: boolean): void;
}

/** The server says something each second. */
export const SILENT_AFTER_MS = 3000;
/** Marks that wait for a thin line would come too late: above this much unsent they are left out. */
const MOST_UNSENT_BYTES = 4096;

export class RoomLine {
  private socket: RoomSocket | null = null;
  private attempt = 0;
  private stopped = true;
  private heardAtMs = 0;

  constructor(private readonly doors: RoomDoors) {}

  start(): void {
    this.stopped = false;
    this.connect();
  }

  stop(): void {
    this.stopped = true;
    this.release();
  }

  /** To be called now and then: a line on which nothing comes is taken anew. */
  look(): void {
    if (!this.stopped && this.socket !== null && this.doors.now() - this.heardAtMs > SILENT_AFTER_MS) {
      this.lose();
    }
  }

  /** False where it did not go out: there is no line, or it is full. */
  say(said: Said): boolean {
    const { socket } = this;
    if (socket === null || this.attempt > 0 || socket.bufferedAmount > MOST_UNSENT_BYTES) return false;
    socket.send(JSON.stringify(said));
    return true;
  }

  private connect(): void {
    if (this.stopped) return;
    const socket = this.doors.open();
    this.socket = socket;
    this.heardAtMs = this.doors.now();
    socket.onopen = () => {
      socket.send(JSON.stringify({ next: true } satisfies Said));
    };
    socket.onmessage = ({ data }) => {
      this.take(socket, data);
    };
    socket.onclose = () => {
      this.lose();
    };
  }

  private take(socket: RoomSocket, data: unknown): void {
    let message: RoomMessage;
    try {
      message = JSON.parse(String(data)) as RoomMessage;
    } catch {
      this.lose();
      return;
    }
    this.heardAtMs = this.doors.now();
    this.attempt = 0;
    this.doors.onLine(true);
    this.doors.onMessage(message);
    if (this.socket === socket) socket.send(JSON.stringify({ next: true } satisfies Said));
  }

  private lose(): void {
    this.release();
    this.doors.onLine(false);
    if (this.stopped) return;
    const waitMs = waitBeforeMs(this.attempt);
    this.attempt += 1;
    this.doors.later(() => {
      if (this.socket === null) this.connect();
    }, waitMs);
  }

  private release(): void {
    const { socket } = this;
    this.socket = null;
    if (socket === null) return;
    socket.onopen = socket.onmessage = socket.onclose = null;
    socket.close();
  }
}
