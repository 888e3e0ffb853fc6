// The connection to `/ws/camera`: answers pings, counts credit, sends an image in parts. Reconnects.
import { ReconnectingSocket, type WebSocketLike } from "../live/reconnectingSocket";
import type { CameraFacts, FrameTime, Note, ServerMessage, Problem, Welcome } from "./messages";

export interface PhoneSocket extends WebSocketLike {
  readonly bufferedAmount: number;
  send(data: string | ArrayBuffer): void;
}

interface PhoneConnectionOptions {
  open(): PhoneSocket;
  later(action: () => void, waitMs: number): void;
  nowMs(): number;
  onWelcome(welcome: Welcome): void;
  onNote(note: Note): void;
  /** The server rejects this device's images; the connection is not retried. */
  onRejected(problem: Problem): void;
  onLost(): void;
}

/** The server sends a message twice a second. */
export const QUIET_MS = 2500;

export class PhoneConnection {
  private readonly socket: ReconnectingSocket<PhoneSocket>;
  private welcome: Welcome | null = null;
  private facts: CameraFacts | null = null;
  private credit = 0;
  private sent = 0;
  private lastReceivedAtMs = 0;

  constructor(
    key: string,
    private readonly options: PhoneConnectionOptions,
  ) {
    this.socket = new ReconnectingSocket<PhoneSocket>({
      open: () => options.open(),
      later: (action, waitMs) => {
        options.later(action, waitMs);
      },
      onOpen: (socket) => {
        this.lastReceivedAtMs = options.nowMs();
        socket.send(JSON.stringify({ hello: { key } }));
      },
      onData: (data) => {
        this.receive(data);
      },
      onLost: () => {
        this.forget();
        options.onLost();
      },
    });
  }

  start(): void {
    this.socket.start();
  }

  stop(): void {
    this.socket.stop();
    this.forget();
  }

  /** Settings granted by the browser, sent again on each connection. */
  describe(facts: CameraFacts): void {
    const changed = JSON.stringify(facts) !== JSON.stringify(this.facts);
    this.facts = facts;
    if (changed && this.welcome !== null) this.sendMessage({ camera: facts });
  }

  /** Whether an image may be captured: credit is available and the previous image has left this device. */
  get isFree(): boolean {
    const socket = this.socket.openSocket;
    return (
      socket !== null &&
      this.welcome !== null &&
      this.facts !== null &&
      this.sent < this.credit &&
      socket.bufferedAmount === 0
    );
  }

  /** False if the connection was lost between the frame and its JPEG. */
  send(jpeg: ArrayBuffer, time: FrameTime): boolean {
    const socket = this.socket.openSocket;
    if (socket === null || this.welcome === null || this.sent >= this.credit) return false;
    this.sent += 1;
    this.sendMessage({ image: { bytes: jpeg.byteLength, ...time } });
    for (let at = 0; at < jpeg.byteLength; at += this.welcome.part_bytes) {
      socket.send(jpeg.slice(at, at + this.welcome.part_bytes));
    }
    return true;
  }

  /** Call periodically: reconnects if the server is silent. */
  checkTimeout(): void {
    if (this.socket.openSocket !== null && this.options.nowMs() - this.lastReceivedAtMs > QUIET_MS)
      this.socket.reconnect();
  }

  private receive(data: unknown): void {
    const nowMs = this.options.nowMs();
    const message = serverMessageFrom(data);
    if (message === null) {
      this.socket.reconnect();
      return;
    }
    this.lastReceivedAtMs = nowMs;
    this.socket.markReceived();
    if ("note" in message) {
      // Answered at once: any delay here would count as clock offset.
      this.sendMessage({ pong: { ping: message.note.ping, at_ms: nowMs } });
      this.credit = message.note.credit;
      this.options.onNote(message.note);
    } else if ("welcome" in message) {
      this.welcome = message.welcome;
      if (this.facts !== null) this.sendMessage({ camera: this.facts });
      this.options.onWelcome(message.welcome);
    } else {
      this.stop();
      this.options.onRejected(message.rejected);
    }
  }

  private sendMessage(message: object): void {
    this.socket.openSocket?.send(JSON.stringify(message));
  }

  private forget(): void {
    this.welcome = null;
    this.credit = this.sent = 0;
  }
}

function serverMessageFrom(data: unknown): ServerMessage | null {
  try {
    const message: unknown = typeof data === "string" ? JSON.parse(data) : null;
    if (typeof message !== "object" || message === null) return null;
    return "note" in message || "welcome" in message || "rejected" in message
      ? (message as ServerMessage)
      : null;
  } catch {
    return null;
  }
}
