// The line to /ws/room: asks for the next message when one is dealt with. `live/keptLine.ts` takes it up again.
import { KeptLine, type KeptSocket } from "../live/keptLine";
import type { RoomMessage, Said } from "./messages";

export interface RoomSocket extends KeptSocket {
  readonly bufferedAmount: number;
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
const MAX_UNSENT_BYTES = 4096;
const NEXT = JSON.stringify({ next: true } satisfies Said);

export class RoomLine {
  private readonly kept: KeptLine<RoomSocket>;
  private heardAtMs = 0;

  constructor(private readonly doors: RoomDoors) {
    this.kept = new KeptLine<RoomSocket>({
      open: () => {
        this.heardAtMs = doors.now();
        return doors.open();
      },
      later: (action, waitMs) => {
        doors.later(action, waitMs);
      },
      onOpen: (socket) => {
        socket.send(NEXT);
      },
      onData: (data) => {
        this.take(data);
      },
      onLost: () => {
        doors.onLine(false);
      },
    });
  }

  start(): void {
    this.kept.start();
  }

  stop(): void {
    this.kept.stop();
  }

  /** To be called now and then: a line on which nothing comes is taken anew. */
  look(): void {
    if (this.kept.socket !== null && this.doors.now() - this.heardAtMs > SILENT_AFTER_MS) this.kept.lose();
  }

  /** False where it did not go out: there is no line, or it is full. */
  say(said: Said): boolean {
    const { socket } = this.kept;
    if (socket === null || !this.kept.hasHeard || socket.bufferedAmount > MAX_UNSENT_BYTES) return false;
    socket.send(JSON.stringify(said));
    return true;
  }

  private take(data: unknown): void {
    let message: RoomMessage;
    try {
      message = JSON.parse(String(data)) as RoomMessage;
    } catch {
      this.kept.lose();
      return;
    }
    this.heardAtMs = this.doors.now();
    this.kept.heard();
    this.doors.onLine(true);
    this.doors.onMessage(message);
    // Where hearing it has ended the line, there is none to ask for more.
    this.kept.standing?.send(NEXT);
  }
}
