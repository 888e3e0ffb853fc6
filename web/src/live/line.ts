// The line to /ws/view: grants one image at a time. `keptLine.ts` takes it up again after a loss.
import { frameFromBytes, type ViewFrame } from "./frame";
import { KeptLine, type KeptSocket } from "./keptLine";

export type LinkState = "connecting" | "open" | "lost";

export interface Socket extends KeptSocket {
  binaryType: BinaryType;
}

export interface LineDoors {
  open(): Socket;
  later(action: () => void, waitMs: number): void;
  onLink(state: LinkState): void;
  onFrame(frame: ViewFrame): void;
}

export class ViewLine {
  private readonly kept: KeptLine<Socket>;

  constructor(private readonly doors: LineDoors) {
    this.kept = new KeptLine<Socket>({
      open: () => {
        const socket = doors.open();
        socket.binaryType = "arraybuffer";
        return socket;
      },
      later: (action, waitMs) => {
        doors.later(action, waitMs);
      },
      onOpen: () => {
        doors.onLink("open");
        this.grant();
      },
      onData: (data) => {
        this.take(data);
      },
      onLost: () => {
        doors.onLink("lost");
      },
    });
  }

  start(): void {
    this.kept.start();
  }

  stop(): void {
    this.kept.stop();
  }

  /** Give up this line and take a new one at once. */
  restart(): void {
    this.kept.lose();
  }

  /** The last image is dealt with, and the page needed so long for that: the server may send the newest one. */
  grant(showingMs?: number): void {
    const spent = showingMs === undefined ? {} : { showing_ms: Math.round(showingMs) };
    this.kept.standing?.send(JSON.stringify({ next: true, ...spent }));
  }

  /** No picture larger than this from the next one on: the device cannot show more. */
  limitSize(largest: string): void {
    this.kept.standing?.send(JSON.stringify({ largest }));
  }

  /** Ask for pictures of another size, from the next one on. */
  askSize(size: string): void {
    this.kept.standing?.send(JSON.stringify({ size }));
  }

  private take(data: unknown): void {
    let frame: ViewFrame;
    try {
      if (!(data instanceof ArrayBuffer)) return;
      frame = frameFromBytes(data);
    } catch {
      // What cannot be read is not shown; a new line starts clean, and says so until it stands.
      this.kept.lose();
      return;
    }
    this.kept.heard();
    this.doors.onFrame(frame);
  }
}
