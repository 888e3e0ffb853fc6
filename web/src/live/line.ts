// The line to /ws/view: opens, grants one image at a time, and comes back by itself after a loss.
import { waitBeforeMs } from "./backoff";
import { frameFromBytes, type ViewFrame } from "./frame";

export type LinkState = "connecting" | "open" | "lost";

/** What is used of a WebSocket; tests bring their own. */
export interface Socket {
  binaryType: BinaryType;
  onopen: (() => void) | null;
  onmessage: ((event: { data: unknown }) => void) | null;
  onclose: (() => void) | null;
  send(text: string): void;
  close(): void;
}

export interface LineDoors {
  open(): Socket;
  later(action: () => void, waitMs: number): void;
  onLink(state: LinkState): void;
  onFrame(frame: ViewFrame): void;
}

/** A server that takes the call but never answers is left after this long. */
const ANSWER_WITHIN_MS = 2000;
const GRANT = JSON.stringify({ next: true });

export class ViewLine {
  private socket: Socket | null = null;
  private attempt = 0;
  private isOpen = false;
  private stopped = false;

  constructor(private readonly doors: LineDoors) {}

  start(): void {
    this.stopped = false;
    this.connect();
  }

  stop(): void {
    this.stopped = true;
    this.release();
  }

  /** Give up this line and take a new one at once. */
  restart(): void {
    if (this.stopped) return;
    this.lose();
  }

  /** The last image is dealt with: the server may send the newest one. */
  grant(): void {
    this.socket?.send(GRANT);
  }

  /** Ask for pictures of another size, from the next one on. */
  askSize(size: string): void {
    if (this.isOpen) this.socket?.send(JSON.stringify({ size }));
  }

  private connect(): void {
    if (this.stopped) return;
    const socket = this.doors.open();
    this.socket = socket;
    let opened = false;
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      opened = true;
      this.isOpen = true;
      this.doors.onLink("open");
      this.grant();
    };
    socket.onmessage = ({ data }) => {
      this.take(data);
    };
    socket.onclose = () => {
      this.lose();
    };
    this.doors.later(() => {
      if (!opened && this.socket === socket) this.lose();
    }, ANSWER_WITHIN_MS);
  }

  private take(data: unknown): void {
    let frame: ViewFrame;
    try {
      if (!(data instanceof ArrayBuffer)) return;
      frame = frameFromBytes(data);
    } catch {
      // What cannot be read is not shown; a new line starts clean, and says so until it stands.
      this.lose();
      return;
    }
    this.attempt = 0;
    this.doors.onFrame(frame);
  }

  private lose(): void {
    this.release();
    this.doors.onLink("lost");
    if (this.stopped) return;
    const waitMs = waitBeforeMs(this.attempt);
    this.attempt += 1;
    this.doors.later(() => {
      if (this.socket === null) this.connect();
    }, waitMs);
  }

  private release(): void {
    const socket = this.socket;
    this.socket = null;
    this.isOpen = false;
    if (socket === null) return;
    socket.onopen = socket.onmessage = socket.onclose = null;
    socket.close();
  }
}
