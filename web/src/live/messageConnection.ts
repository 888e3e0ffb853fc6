// The connection to /ws/live: each image's message as soon as it is tracked, without waiting for a picture. Reconnects
// after a loss (`reconnectingSocket.ts`). Without it, figures arrive with each picture.
import { messageFromText } from "./frame";
import type { LiveMessage } from "./messages";
import { ReconnectingSocket, type WebSocketLike } from "./reconnectingSocket";

interface MessageConnectionOptions {
  open(): WebSocketLike;
  later(action: () => void, waitMs: number): void;
  onMessage(message: LiveMessage): void;
}

export class MessageConnection {
  private readonly socket: ReconnectingSocket<WebSocketLike>;

  constructor(private readonly options: MessageConnectionOptions) {
    this.socket = new ReconnectingSocket<WebSocketLike>({
      open: () => options.open(),
      later: (action, waitMs) => {
        options.later(action, waitMs);
      },
      onOpen: () => undefined,
      onData: (data) => {
        this.receive(data);
      },
      onLost: () => undefined,
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

  private receive(data: unknown): void {
    let message: LiveMessage;
    try {
      if (typeof data !== "string") return;
      message = messageFromText(data);
    } catch {
      // As with frames: an invalid message is dropped, and a new connection starts clean.
      this.socket.reconnect();
      return;
    }
    this.socket.markReceived();
    this.options.onMessage(message);
  }
}
