// The connection to /ws/view: requests one image at a time; reconnects after a loss (`reconnectingSocket.ts`).
import { frameFromBytes, type ViewFrame } from "./frame";
import { ReconnectingSocket, type WebSocketLike } from "./reconnectingSocket";

export type LinkState = "connecting" | "open" | "lost";

export interface ViewSocket extends WebSocketLike {
  binaryType: BinaryType;
}

interface ViewConnectionOptions {
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

  /** Closes the connection and opens a new one. */
  restart(): void {
    this.socket.reconnect();
  }

  /** Requests the newest image, and reports how long the page took to display the last one. */
  requestNext(showingMs?: number): void {
    const spent = showingMs === undefined ? {} : { showing_ms: Math.round(showingMs) };
    this.socket.openSocket?.send(JSON.stringify({ next: true, ...spent }));
  }

  /** Limits the picture size from the next image on to what the device can display. */
  limitSize(largest: string): void {
    this.socket.openSocket?.send(JSON.stringify({ largest }));
  }

  /** Limits the picture rate: the shortest mean interval between images. */
  limitRate(intervalMs: number): void {
    this.socket.openSocket?.send(JSON.stringify({ interval_ms: intervalMs }));
  }

  /** Requests another picture size from the next image on. */
  askSize(size: string): void {
    this.socket.openSocket?.send(JSON.stringify({ size }));
  }

  private receive(data: unknown): void {
    let frame: ViewFrame;
    try {
      if (!(data instanceof ArrayBuffer)) return;
      frame = frameFromBytes(data);
    } catch {
      // An invalid frame is dropped; a new connection starts clean.
      this.socket.reconnect();
      return;
    }
    this.socket.markReceived();
    this.options.onFrame(frame);
  }
}
