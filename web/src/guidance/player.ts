// Plays the guiding sound, pulse by pulse. Without a newer image nothing more is played.
import type { Note, Tone } from "./tone";

/** A pulse begins at most this long after the image that it is about. */
const AHEAD_S = 0.02;
const PULSE_S = 0.09;
const TICK_S = 0.03;
const EDGE_S = 0.008;
const HUSH_S = 0.005;
/** The first note is the offset, the second the angle, then a rest. */
const ANGLE_AFTER_S = 0.14;
const CYCLE_S = 0.6;
/** Well below an alarm, which plays at 1. */
const MAX_GAIN = 0.25;

export class GuidancePlayer {
  private context: AudioContext | null = null;
  private output: GainNode | null = null;
  private nextAtS = 0;

  /** Must be called from a touch; resolves to whether sound works. */
  async start(): Promise<boolean> {
    if (this.context === null) {
      this.context = new AudioContext();
      this.output = new GainNode(this.context);
      this.output.connect(this.context.destination);
    }
    await this.context.resume();
    return this.context.state === "running";
  }

  /** Releases the sound device. */
  stop(): void {
    void this.context?.close();
    this.context = this.output = null;
    this.nextAtS = 0;
  }

  /** Plays the next pulse of this tone if it is due; null ends one that is playing. Called with each image. */
  play(tone: Tone | null, volume: number): void {
    const { context, output } = this;
    if (context === null || output === null) return;
    const nowS = context.currentTime;
    output.gain.setTargetAtTime(tone === null ? 0 : 1, nowS, HUSH_S);
    if (tone === null) return;
    if (nowS + AHEAD_S < this.nextAtS) return;
    const atS = Math.max(nowS, this.nextAtS - AHEAD_S);
    const gain = MAX_GAIN * volume;
    if (tone.kind === "drill") {
      pulse(output, { hz: tone.hz, pan: 0 }, atS, TICK_S, gain);
      this.nextAtS = atS + 1 / tone.ticksPerS;
      return;
    }
    pulse(output, tone.offset, atS, PULSE_S, gain);
    pulse(output, tone.angle, atS + ANGLE_AFTER_S, PULSE_S, gain);
    this.nextAtS = atS + CYCLE_S;
  }
}

function pulse(output: GainNode, { hz, pan }: Note, atS: number, lastsS: number, peak: number): void {
  const { context } = output;
  const source = new OscillatorNode(context, { frequency: hz });
  const gain = new GainNode(context, { gain: 0 });
  source.connect(gain).connect(new StereoPannerNode(context, { pan })).connect(output);
  gain.gain.setValueAtTime(0, atS);
  gain.gain.linearRampToValueAtTime(peak, atS + EDGE_S);
  gain.gain.setValueAtTime(peak, atS + lastsS - EDGE_S);
  gain.gain.linearRampToValueAtTime(0, atS + lastsS);
  source.start(atS);
  source.stop(atS + lastsS);
}
