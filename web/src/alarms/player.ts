// Plays alarm sounds. Browsers allow sound only after a touch on the page.
import type { Sound } from "../live/messages";
import type { Dashboard } from "../live/start";
import type { RequestedSound } from "./verdict";

type SoundMessage = Dashboard["sounds"][number];
/** Shorter than the first pulse of a burst, so that a change is heard at once and without a click. */
const FADE_S = 0.01;

export class AlarmPlayer {
  private context: AudioContext | null = null;
  private readonly loops = new Map<Sound, AudioBuffer>();
  private playing: { wanted: RequestedSound; source: AudioBufferSourceNode; gain: GainNode } | null = null;

  /** Whether an alarm would be heard now, as far as the browser reports. */
  get armed(): boolean {
    return this.context?.state === "running" && this.loops.size > 0;
  }

  /** Must be called from a touch; resolves to whether sound works. */
  async arm(sounds: readonly SoundMessage[]): Promise<boolean> {
    this.context ??= new AudioContext();
    const { context } = this;
    await context.resume();
    for (const { priority, path, repeat_every_s } of sounds) {
      const answer = await fetch(path);
      if (!answer.ok) return false;
      const burst = await context.decodeAudioData(await answer.arrayBuffer());
      this.loops.set(priority, looped(context, burst, repeat_every_s));
    }
    return this.armed;
  }

  /** Plays exactly this; a sound that is already playing continues. */
  want(wanted: RequestedSound): void {
    const now = this.playing?.wanted;
    if (now ? now.sound === wanted.sound && now.number === wanted.number : wanted.sound === "silent") return;
    this.hush();
    const { context } = this;
    const buffer = this.loops.get(wanted.sound);
    if (context === null || buffer === undefined) return;
    const source = new AudioBufferSourceNode(context, { buffer, loop: true });
    const gain = new GainNode(context);
    source.connect(gain).connect(context.destination);
    source.start();
    this.playing = { wanted, source, gain };
  }

  private hush(): void {
    if (this.playing === null || this.context === null) return;
    const { source, gain } = this.playing;
    const endS = this.context.currentTime + FADE_S;
    gain.gain.linearRampToValueAtTime(0, endS);
    source.stop(endS);
    this.playing = null;
  }
}

/** A burst with its silence, looped by the sound hardware so that a busy page does not delay it. */
function looped(context: AudioContext, burst: AudioBuffer, everyS: number): AudioBuffer {
  const whole = context.createBuffer(1, Math.round(everyS * burst.sampleRate), burst.sampleRate);
  whole.copyToChannel(burst.getChannelData(0), 0);
  return whole;
}
