// The line to `/ws/camera`: answers pings, counts credit, sends an image in parts. `keptLine.ts` keeps it.
import { KeptLine, type KeptSocket } from "../live/keptLine";
import type { CameraFacts, FrameTime, Note, Told, Problem, Welcome } from "./messages";

export interface PhoneSocket extends KeptSocket {
  readonly bufferedAmount: number;
  send(data: string | ArrayBuffer): void;
}

export interface PhoneDoors {
  open(): PhoneSocket;
  later(action: () => void, waitMs: number): void;
  nowMs(): number;
  onWelcome(welcome: Welcome): void;
  onNote(note: Note): void;
  /** The server does not take this device's images; the line is given up. */
  onRejected(problem: Problem): void;
  onLost(): void;
}

/** The server speaks twice a second. */
export const QUIET_MS = 2500;

export class PhoneLine {
  private readonly kept: KeptLine<PhoneSocket>;
  private welcome: Welcome | null = null;
  private facts: CameraFacts | null = null;
  private credit = 0;
  private sent = 0;
  private heardAtMs = 0;

  constructor(
    key: string,
    private readonly doors: PhoneDoors,
  ) {
    this.kept = new KeptLine<PhoneSocket>({
      open: () => doors.open(),
      later: (action, waitMs) => {
        doors.later(action, waitMs);
      },
      onOpen: (socket) => {
        this.heardAtMs = doors.nowMs();
        socket.send(JSON.stringify({ hello: { key } }));
      },
      onData: (data) => {
        this.take(data);
      },
      onLost: () => {
        this.forget();
        doors.onLost();
      },
    });
  }

  start(): void {
    this.kept.start();
  }

  stop(): void {
    this.kept.stop();
    this.forget();
  }

  /** What the browser granted, said again on each new line. */
  describe(facts: CameraFacts): void {
    const changed = JSON.stringify(facts) !== JSON.stringify(this.facts);
    this.facts = facts;
    if (changed && this.welcome !== null) this.say({ camera: facts });
  }

  /** Whether an image may be taken for sending: granted, and none of the last one waits on this device. */
  get isFree(): boolean {
    const socket = this.kept.standing;
    return (
      socket !== null &&
      this.welcome !== null &&
      this.facts !== null &&
      this.sent < this.credit &&
      socket.bufferedAmount === 0
    );
  }

  /** Whether it went: between the frame and its JPEG the line may have been lost. */
  send(jpeg: ArrayBuffer, time: FrameTime): boolean {
    const socket = this.kept.standing;
    if (socket === null || this.welcome === null || this.sent >= this.credit) return false;
    this.sent += 1;
    this.say({ image: { bytes: jpeg.byteLength, ...time } });
    for (let at = 0; at < jpeg.byteLength; at += this.welcome.part_bytes) {
      socket.send(jpeg.slice(at, at + this.welcome.part_bytes));
    }
    return true;
  }

  /** To be called now and then: a server that fell silent is left for a new line. */
  look(): void {
    if (this.kept.standing !== null && this.doors.nowMs() - this.heardAtMs > QUIET_MS) this.kept.lose();
  }

  private take(data: unknown): void {
    const nowMs = this.doors.nowMs();
    const told = toldIn(data);
    if (told === null) {
      this.kept.lose();
      return;
    }
    this.heardAtMs = nowMs;
    this.kept.heard();
    if ("note" in told) {
      // At once: each moment spent here would count as a difference of the clocks.
      this.say({ pong: { ping: told.note.ping, at_ms: nowMs } });
      this.credit = told.note.credit;
      this.doors.onNote(told.note);
    } else if ("welcome" in told) {
      this.welcome = told.welcome;
      if (this.facts !== null) this.say({ camera: this.facts });
      this.doors.onWelcome(told.welcome);
    } else {
      this.stop();
      this.doors.onRejected(told.rejected);
    }
  }

  private say(message: object): void {
    this.kept.standing?.send(JSON.stringify(message));
  }

  private forget(): void {
    this.welcome = null;
    this.credit = this.sent = 0;
  }
}

function toldIn(data: unknown): Told | null {
  try {
    const told: unknown = typeof data === "string" ? JSON.parse(data) : null;
    if (typeof told !== "object" || told === null) return null;
    return "note" in told || "welcome" in told || "rejected" in told ? (told as Told) : null;
  } catch {
    return null;
  }
}
