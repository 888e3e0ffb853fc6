import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { GuidancePlayer } from "./player";
import type { Tone } from "./tone";

/** What was started, with its time. */
let started: { hz: number; atS: number }[];
let nowS: number;
let outputs: number[];

class Param {
  setValueAtTime(): void {
    // Not needed here.
  }
  linearRampToValueAtTime(): void {
    // Not needed here.
  }
  setTargetAtTime(value: number): void {
    outputs.push(value);
  }
}

class Node {
  readonly gain = new Param();
  private readonly hz: number;
  constructor(
    readonly context: Context,
    { frequency = 0 }: { frequency?: number } = {},
  ) {
    this.hz = frequency;
  }
  connect(to: Node): Node {
    return to;
  }
  start(atS: number): void {
    started.push({ hz: this.hz, atS });
  }
  stop(): void {
    // Not needed here.
  }
}

class Context {
  state = "suspended";
  readonly destination = new Node(this);
  get currentTime(): number {
    return nowS;
  }
  async resume(): Promise<void> {
    this.state = "running";
    return Promise.resolve();
  }
  async close(): Promise<void> {
    return Promise.resolve();
  }
}

beforeEach(() => {
  [started, outputs, nowS] = [[], [], 0];
  vi.stubGlobal("AudioContext", Context);
  for (const name of ["GainNode", "OscillatorNode", "StereoPannerNode"]) vi.stubGlobal(name, Node);
});
afterEach(() => {
  vi.unstubAllGlobals();
});

const ALIGNED: Tone = { kind: "align", offset: { hz: 440, pan: 0 }, angle: { hz: 660, pan: 0 } };
const TICKS: Tone = { kind: "drill", ticksPerS: 4, hz: 1000 };

/** Images at 30 Hz for a second. */
function images(player: GuidancePlayer, tone: Tone | null, seconds = 1): void {
  for (const endS = nowS + seconds; nowS < endS; nowS += 1 / 30) player.play(tone, 1);
}

test("plays pairs of notes while images come, and nothing more without them", async () => {
  const player = new GuidancePlayer();
  expect(await player.start()).toBe(true);
  images(player, ALIGNED, 1.1);
  expect(started.map(({ hz }) => hz)).toEqual([440, 660, 440, 660]);
  nowS += 10;
  expect(started).toHaveLength(4);
  // No note is about an image before the pause, and none is made up for.
  images(player, ALIGNED, 0.1);
  expect(started).toHaveLength(6);
  expect(started[4]?.atS).toBeGreaterThan(11);
});

test("ticks at its rate", async () => {
  const player = new GuidancePlayer();
  await player.start();
  images(player, TICKS, 2);
  expect(started.length).toBeGreaterThanOrEqual(7);
  expect(started.length).toBeLessThanOrEqual(9);
});

test("an alarm ends also the note that is playing", async () => {
  const player = new GuidancePlayer();
  await player.start();
  player.play(ALIGNED, 1);
  player.play(null, 1);
  expect(outputs.at(-1)).toBe(0);
  images(player, null);
  expect(started).toHaveLength(2);
});

test("without a touch it plays nothing", () => {
  images(new GuidancePlayer(), ALIGNED);
  expect(started).toEqual([]);
});
