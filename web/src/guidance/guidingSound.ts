// The guiding sound of this page: off until somebody turns it on, and after each load.
import { GuidancePlayer } from "./player";
import { toneOf, type Tone } from "./tone";
import { setGuiding } from "../alarms/alarmRequests";
import { alarmsVerdict } from "../alarms/verdict";
import type { View } from "../live/view";

export interface GuidingState {
  isOn: boolean;
  /** The browser did not allow the sound, or there is no device for it. */
  failed: boolean;
  /** 0 to 1. */
  volume: number;
}

const STORAGE_KEY = "coaxial.guiding-volume";
const FIRST_VOLUME = 0.5;

class GuidingSound {
  private state: GuidingState = { isOn: false, failed: false, volume: storedVolume() };
  private readonly player = new GuidancePlayer();
  private readonly listeners = new Set<() => void>();
  /** Plays in place of the images, while somebody listens to an example. */
  private example: { tone: Tone; untilMs: number } | null = null;

  readonly subscribe = (listener: () => void): (() => void) => {
    this.listeners.add(listener);
    return () => {
      this.listeners.delete(listener);
    };
  };

  readonly current = (): GuidingState => this.state;

  /** Must be called from a touch. */
  turnOn(): void {
    this.player.start().then(
      (works) => {
        this.change({ isOn: works, failed: !works });
      },
      () => {
        this.change({ isOn: false, failed: true });
      },
    );
  }

  turnOff(): void {
    this.example = null;
    this.player.stop();
    this.change({ isOn: false, failed: false });
  }

  setVolume(volume: number): void {
    try {
      localStorage.setItem(STORAGE_KEY, String(volume));
    } catch {
      // The volume then applies to this visit only.
    }
    this.change({ volume });
  }

  /** Plays an example for this long, unless there is an alarm. */
  playExample(tone: Tone, untilMs: number): void {
    this.example = { tone, untilMs };
  }

  /** Plays what belongs to this state of the page. */
  paint(view: View): void {
    if (!this.state.isOn) return;
    const alarms = alarmsVerdict(view, view.firstMessage === "received");
    if (this.example !== null && view.nowMs > this.example.untilMs) this.example = null;
    const tone =
      this.example === null ? toneOf(view.numbers, alarms) : exampleBeside(this.example.tone, view);
    this.player.play(tone, this.state.volume);
  }

  private change(changes: Partial<GuidingState>): void {
    this.state = { ...this.state, ...changes };
    setGuiding(this.state.isOn);
    for (const listener of this.listeners) listener();
  }
}

/** An example is not about an image, but it does not play beside an alarm either. */
function exampleBeside(tone: Tone, view: View): Tone | null {
  return view.newest?.alarms.sound === "silent" ? tone : null;
}

function storedVolume(): number {
  try {
    const stored = Number(localStorage.getItem(STORAGE_KEY) ?? FIRST_VOLUME);
    return stored >= 0 && stored <= 1 ? stored : FIRST_VOLUME;
  } catch {
    return FIRST_VOLUME;
  }
}

export const guidingSound = new GuidingSound();
