// All that the page knows of now: one line in, one verdict for each pane out, looked at again with every
// image of the screen and by a timer, so that what is old goes by itself.
import {
  isOfNow,
  numbersVerdict,
  situationAtLoad,
  videoVerdict,
  type Limits,
  type NumbersVerdict,
  type Situation,
  type Taken,
} from "./assess";
import type { PictureChoice } from "./carried";
import { ServerClock } from "./clock";
import { firstMessageAt } from "./firstMessage";
import type { Draw, Shown } from "./draw";
import type { ViewFrame } from "./frame";
import type { LinkState } from "./line";
import { Load } from "./load";
import type { LiveMessage } from "./messages";
import { ReturnHold } from "./returnHold";
import { SceneAge, type SceneNote, type SceneVerdict } from "./sceneAge";
import { agesOf, type PaintedImage, type View } from "./view";

export type { Ages, View } from "./view";

export class Live {
  private draw: Draw = () => Promise.resolve(false);
  private readonly is: Situation;
  private trackedAtMs: number | null = null;
  /** Grows with each line, so that what a lost line still delivers is dropped. */
  private generation = 0;
  private readonly clock = new ServerClock();
  private readonly hold = new ReturnHold();
  private readonly sceneAge = new SceneAge();
  /** What this page can carry, and what is slow. */
  readonly load: Load;
  private onChoice: (choice: PictureChoice) => void = () => undefined;
  onShown: ((image: PaintedImage) => void) | null = null;
  private readonly painters = new Set<(view: View) => void>();

  constructor(private readonly now: () => number) {
    this.is = situationAtLoad(now());
    this.load = new Load(now);
  }

  /** Called with every look; must only touch the page where something changed. */
  onLook(painter: (view: View) => void): () => void {
    this.painters.add(painter);
    return () => this.painters.delete(painter);
  }

  look(): View {
    const nowMs = this.now();
    const numbers = this.held(numbersVerdict(this.is, nowMs), nowMs);
    if (numbers.live) this.trackedAtMs = nowMs - numbers.ageMs;
    const video = videoVerdict(this.is, nowMs);
    // A picture that was taken away does not come back: only a new one does.
    if (!video.live) this.is.picture = null;
    const scene: SceneVerdict = this.load.sceneSwitch.isOn
      ? this.sceneAge.verdict(nowMs, this.is.limits.scene_stale_after_ms)
      : { state: "off" };
    const view: View = {
      nowMs,
      link: this.is.link,
      silentMs: this.is.heardAtMs === null ? 0 : nowMs - this.is.heardAtMs,
      firstMessage: firstMessageAt(this.is, nowMs),
      newest: this.is.newest,
      alarms: (isOfNow(numbers) ? this.is.numbers?.alarms : this.is.newest?.alarms) ?? null,
      video,
      numbers,
      untrackedMs: numbers.live || this.trackedAtMs === null ? null : nowMs - this.trackedAtMs,
      scene,
      ages: agesOf(video, numbers, scene, this.clock.aheadMs),
      carried: this.load.look(nowMs, this.is.limits, this.is.newest?.source.rate_hz ?? 0),
      budget: this.load.budget,
    };
    for (const painter of this.painters) painter(view);
    return view;
  }

  setDraw(draw: Draw): void {
    this.draw = draw;
    this.is.canvasSinceMs = this.now();
  }

  /** Who tells the server which size is wanted, now and with each later choice. */
  setOnChoice(onChoice: (choice: PictureChoice) => void): void {
    this.onChoice = onChoice;
  }

  choosePicture(choice: PictureChoice): void {
    this.load.choice = choice;
    this.onChoice(choice);
    this.look();
  }

  get pictureChoice(): PictureChoice {
    return this.load.choice;
  }

  setLimits(limits: Limits): void {
    this.is.limits = limits;
  }

  setHidden(hidden: boolean): void {
    this.is.hidden = hidden;
    // A page in the background is held back by the browser: what it did not hear there says nothing of the server.
    if (!hidden) this.is.waitingSinceMs = this.now();
    this.load.forget();
    this.look();
  }

  setLink(link: LinkState): void {
    this.is.link = link;
    if (link === "open") this.heard();
    else this.forget();
    this.look();
  }

  sceneDrawn(note: SceneNote): void {
    this.sceneAge.drawn(note, this.now());
    this.load.sceneDrawn(note.drawn_by_processor, this.now());
  }

  /** Draw the 3-D scene again, which was switched off for the sake of the figures. */
  switchSceneOn(): void {
    this.sceneAge.reload();
    this.load.sceneSwitch.switchOn(this.now());
    this.look();
  }

  /** Takes one frame; resolves when it stands on the page and the next may be granted. */
  async take({ message, jpeg }: ViewFrame): Promise<Shown> {
    const generation = this.generation;
    const isCurrent = (): boolean => generation === this.generation;
    const receivedAtMs = (this.is.waitingSinceMs = this.heard());
    const showing = this.load.begin(receivedAtMs);
    this.is.newest = message;
    const taken = this.takenFrom(message, receivedAtMs);
    if (taken) this.sceneAge.image(taken.snapshot.image_number, taken.capturedAtMs);
    // Numbers and picture change together, when the picture is ready: both are of one image.
    const onDecoded = showing.decoded;
    const drawn = taken !== null && jpeg.byteLength > 0 && (await this.draw(jpeg, isCurrent, onDecoded));
    // Not before its picture stands: to say that there is none would be a false alarm.
    this.is.everHeard = true;
    if (!isCurrent()) return { stands: false, showingMs: 0 };
    this.is.numbers = taken;
    showing.stands();
    const sentAtMs = this.clock.pageMs(message.sent_at_s);
    if (drawn) {
      this.is.picture = taken;
      this.is.lastPictureAtMs = taken.capturedAtMs;
      this.is.canvasSinceMs = null;
      const times = showing.times(sentAtMs, taken.capturedAtMs);
      this.load.shown(times, taken.snapshot, message.shown_scale_ratio);
      this.onShown?.({ message, receivedAtMs });
    }
    this.look();
    return { stands: true, showingMs: showing.deviceMs(sentAtMs, this.load.sharesMachine) };
  }

  /** The answer to a question that was asked because the line was quiet, or to compare clocks. */
  answered(message: LiveMessage | null, askedAtMs: number, generation: number): void {
    if (generation !== this.generation) return;
    const answeredAtMs = (this.is.waitingSinceMs = this.heard());
    if (message === null) return;
    this.clock.sample(askedAtMs, answeredAtMs, message.sent_at_s);
    if (this.is.newest === null || message.sequence > this.is.newest.sequence) this.is.newest = message;
  }

  get hasNews(): boolean {
    return this.is.newest !== null;
  }

  get currentGeneration(): number {
    return this.generation;
  }

  /** For how long nothing has come over an open line; 0 while there is none. */
  quietMs(): number {
    return this.is.link !== "open" || this.is.heardAtMs === null ? 0 : this.now() - this.is.heardAtMs;
  }

  private heard(): number {
    return (this.is.heardAtMs = this.now());
  }

  private forget(): void {
    this.generation += 1;
    this.is.newest = this.is.numbers = this.is.picture = null;
    this.is.lastPictureAtMs = null;
    this.clock.forget();
    this.sceneAge.forget();
    this.load.forget();
  }

  private takenFrom(message: LiveMessage, receivedAtMs: number): Taken | null {
    const { snapshot, headline, alarms } = message;
    if (snapshot === null) return null;
    const capturedAtMs = this.clock.capturedAtMs(receivedAtMs, snapshot.age_ms, snapshot.captured_at_s);
    return { snapshot, headline, alarms, capturedAtMs, receivedAtMs };
  }

  private held(verdict: NumbersVerdict, nowMs: number): NumbersVerdict {
    const old = !verdict.live && verdict.cause === "old";
    const held = this.hold.held(old, nowMs);
    if (!held || !verdict.live) return verdict;
    return { live: false, cause: "old", unread: null, ageMs: verdict.ageMs };
  }
}
