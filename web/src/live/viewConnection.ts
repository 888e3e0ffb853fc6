// The line to /ws/view: grants one image at a time. `reconnectingSocket.ts` takes it up again after a loss.
import { frameFromBytes, type ViewFrame } from "./frame";
import { ReconnectingSocket, type WebSocketLike } from "./reconnectingSocket";

export type LinkState = "connecting" | "open" | "lost";

export interface ViewSocket extends WebSocketLike {
  binaryType: BinaryType;
}

export interface ViewConnectionOptions {
  open(): ViewSocket;
  later(action: () => void, waitMs: number): void;
  onLink(state: LinkState): void;
  onFrame(frame: ViewFrame): void;
}

export class ViewConnection {
  private readonly socket: ReconnectingSocket<ViewSocket>;

  constructor(private readonly options: ViewConnectionOptions) {
    this.socket = new ReconnectingSocket<ViewSocket>({
      open: () => {
        const socket = options.open();
        socket.binaryType = "arraybuffer";
        return socket;
      },
      later: (action, waitMs) => {
        options.later(action, waitMs);
      },
      onOpen: () => {
        options.onLink("open");
        this.requestNext();
      },
      onData: (data) => {
        this.receive(data);
      },
      onLost: () => {
        options.onLink("lost");
      },
    });
  }

  start(): void {
    this.socket.start();
  }

  stop(): void {
    this.socket.stop();
  }

  /** Give up this line and take a new one at once. */
  restart(): void {
    this.socket.reconnect();
  }

  /** The last image is dealt with, and the page needed so long for that: the server may send the newest one. */
  requestNext(showingMs?: number): void {
    const spent = showingMs === undefined ? {} : { showing_ms: Math.round(showingMs) };
    this.socket.openSocket?.send(JSON.stringify({ next: true, ...spent }));
  }

  /** No picture larger than this from the next one on: the device cannot show more. */
  limitSize(largest: string): void {
    this.socket.openSocket?.send(JSON.stringify({ largest }));
  }

  /** Ask for pictures of another size, from the next one on. */
  askSize(size: string): void {
    this.socket.openSocket?.send(JSON.stringify({ size }));
  }

  private receive(data: unknown): void {
    let frame: ViewFrame;
    try {
      if (!(data instanceof ArrayBuffer)) return;
      frame = frameFromBytes(data);
    } catch {
      // What cannot be read is not shown; a new line starts clean, and says so until it stands.
      this.socket.reconnect();
      return;
    }
    this.socket.markReceived();
    this.options.onFrame(frame);
  }
}
