// A WebSocket for tests.
import type { WebSocketLike } from "./reconnectingSocket";

export class FakeSocket implements WebSocketLike {
  onopen: (() => void) | null = null;
  onmessage: ((event: { data: unknown }) => void) | null = null;
  onclose: (() => void) | null = null;
  readonly sent: string[] = [];
  closed = false;
  send(text: string): void {
    this.sent.push(text);
  }
  close(): void {
    this.closed = true;
  }
}

/** For a connection on which the page sends nothing. */
export class SilentSocket extends FakeSocket {
  override send(): void {
    throw new Error("nothing is sent on this connection");
  }
}
