// The live state of the page: takes messages and frames, returns a verdict per pane. Updated by messages and by a
// timer, so that old content is removed without a message.
import {
  numbersVerdict,
  situationAtLoad,
  videoVerdict,
  type Limits,
  type NumbersVerdict,
  type Situation,
  type ReceivedImage,
  type VideoVerdict,
} from "./assess";
import type { PictureChoice } from "./pictureDelivery";
import { ServerClock } from "./clock";
import { firstMessageAt } from "./firstMessage";
import type { Draw, DisplayResult } from "./draw";
import type { ViewFrame } from "./frame";
import type { LinkState } from "./viewConnection";
import { Load } from "./load";
import type { LiveMessage } from "./messages";
import { RecoveryDelay } from "./recoveryDelay";
import { SceneAge, type SceneNote, type SceneVerdict } from "./sceneAge";
import { agesOf, type PaintedImage, type View } from "./view";

export type { Ages, View } from "./view";

export class Live {
  private draw: Draw = () => Promise.resolve(false);
  private readonly situation: Situation;
  private trackedAtMs: number | null = null;
  /** Incremented with each connection, so that late results of a lost connection are dropped. */
  private generation = 0;
  private readonly clock = new ServerClock();
  private readonly recoveryDelay = new RecoveryDelay();
  private readonly sceneAge = new SceneAge();
  /** What this device can display, and what is slow. */
  readonly load: Load;
  private onChoice: (choice: PictureChoice) => void = () => undefined;
  onShown: ((image: PaintedImage) => void) | null = null;
  private readonly painters = new Set<(view: View) => void>();

  constructor(private readonly now: () => number) {
    this.situation = situationAtLoad(now());
    this.load = new Load(now);
  }

  /** Called with every update; must touch the DOM only on change. */
  onUpdate(painter: (view: View) => void): () => void {
    this.painters.add(painter);
    return () => this.painters.delete(painter);
  }

  update(): View {
    const nowMs = this.now();
    const numbers = this.withRecoveryDelay(numbersVerdict(this.situation, nowMs), nowMs);
    if (numbers.live) this.trackedAtMs = nowMs - numbers.ageMs;
    const video = videoVerdict(this.situation, nowMs);
    // A removed picture is not shown again; only a new one is.
    if (!video.live) this.situation.picture = null;
    const scene: SceneVerdict = this.load.sceneSwitch.isOn
      ? this.sceneAge.verdict(nowMs, this.situation.limits.scene_stale_after_ms)
      : { state: "off" };
    const view: View = {
      nowMs,
      link: this.situation.link,
      silentMs: this.situation.lastReceivedAtMs === null ? 0 : nowMs - this.situation.lastReceivedAtMs,
      firstMessage: firstMessageAt(this.situation, nowMs),
      newest: this.situation.newest,
      video,
      numbers,
      untrackedMs: numbers.live || this.trackedAtMs === null ? null : nowMs - this.trackedAtMs,
      scene,
      ages: agesOf(video, numbers, scene, this.clock.aheadMs),
      expiresAtMs: this.expiresAtMs(numbers, video),
      pictureDelivery: this.load.update(
        nowMs,
        this.situation.limits,
        this.situation.newest?.source.rate_hz ?? 0,
      ),
      budget: this.load.budget,
    };
    for (const painter of this.painters) painter(view);
    return view;
  }

  private expiresAtMs(numbers: NumbersVerdict, video: VideoVerdict): number | null {
    const { limits, numbers: image, picture } = this.situation;
    const times = [];
    // At the limit content is still valid; one millisecond later it is not.
    if (numbers.live && image !== null) times.push(image.capturedAtMs + limits.pose_stale_after_ms + 1);
    if (video.live && picture !== null) times.push(picture.capturedAtMs + limits.video_stale_after_ms + 1);
    return times.length === 0 ? null : Math.min(...times);
  }

  setDraw(draw: Draw): void {
    this.draw = draw;
    this.situation.canvasSinceMs = this.now();
  }

  /** Receives the wanted picture size now and with each later choice. */
  setOnChoice(onChoice: (choice: PictureChoice) => void): void {
    this.onChoice = onChoice;
  }

  choosePicture(choice: PictureChoice): void {
    this.load.choice = choice;
    this.onChoice(choice);
    this.update();
  }

  get pictureChoice(): PictureChoice {
    return this.load.choice;
  }

  setLimits(limits: Limits): void {
    this.situation.limits = limits;
  }

  setHidden(hidden: boolean): void {
    this.situation.hidden = hidden;
    // Browsers throttle background pages: silence there says nothing about the server.
    if (!hidden) this.situation.waitingSinceMs = this.now();
    this.load.forget();
    this.update();
  }

  setLink(link: LinkState): void {
    this.situation.link = link;
    if (link === "open") this.markReceived();
    else this.forget();
    this.update();
  }

  sceneDrawn(note: SceneNote): void {
    this.sceneAge.drawn(note, this.now());
    this.load.sceneDrawn(note.drawn_by_processor, this.now());
  }

  /** Draws the 3-D scene again after it was switched off to keep the figures timely. */
  switchSceneOn(): void {
    this.sceneAge.reload();
    this.load.sceneSwitch.switchOn(this.now());
    this.update();
  }

  /** Receives an image's message without its picture, so that figures and alarms do not wait for it. */
  receiveMessage(message: LiveMessage): void {
    // The display depends on the connection that carries the pictures.
    if (this.situation.link !== "open") return;
    const receivedAtMs = (this.situation.waitingSinceMs = this.markReceived());
    this.keepNewest(message, this.receivedImageFrom(message, receivedAtMs));
  }

  /** Receives a frame; resolves when it is displayed and the next may be requested. */
  async receive({ message, jpeg }: ViewFrame): Promise<DisplayResult> {
    const generation = this.generation;
    const isCurrent = (): boolean => generation === this.generation;
    const receivedAtMs = (this.situation.waitingSinceMs = this.markReceived());
    const timer = this.load.begin(receivedAtMs);
    const received = this.receivedImageFrom(message, receivedAtMs);
    this.keepNewest(message, received);
    const onDecoded = timer.markDecoded;
    const drawn = received !== null && jpeg.byteLength > 0 && (await this.draw(jpeg, isCurrent, onDecoded));
    // Only after its picture is displayed: reporting none earlier would be a false alarm.
    this.situation.everReceived = true;
    if (!isCurrent()) return { isDisplayed: false, showingMs: 0 };
    timer.markDisplayed();
    const sentAtMs = this.clock.pageMs(message.sent_at_s);
    if (drawn) {
      this.situation.picture = received;
      this.situation.lastPictureAtMs = received.capturedAtMs;
      this.situation.canvasSinceMs = null;
      const times = timer.times(sentAtMs, received.capturedAtMs);
      this.load.shown(times, received.snapshot, message.shown_scale_ratio);
      this.onShown?.({ message, receivedAtMs });
    }
    this.update();
    return { isDisplayed: true, showingMs: timer.deviceMs(sentAtMs, this.load.sharesMachine) };
  }

  /** Receives the answer to a request sent after silence or for clock comparison. */
  receiveAnswer(message: LiveMessage | null, requestedAtMs: number, generation: number): void {
    if (generation !== this.generation) return;
    const answeredAtMs = (this.situation.waitingSinceMs = this.markReceived());
    if (message === null) return;
    this.clock.sample(requestedAtMs, answeredAtMs, message.sent_at_s);
    this.keepNewest(message, this.receivedImageFrom(message, answeredAtMs));
  }

  get hasMessage(): boolean {
    return this.situation.newest !== null;
  }

  get currentGeneration(): number {
    return this.generation;
  }

  /** How long an open connection has been silent; 0 without a connection. */
  quietMs(): number {
    return this.situation.link !== "open" || this.situation.lastReceivedAtMs === null
      ? 0
      : this.now() - this.situation.lastReceivedAtMs;
  }

  /** Figures come from the newest message; a picture that took longer does not replace them. */
  private keepNewest(message: LiveMessage, received: ReceivedImage | null): void {
    const { newest } = this.situation;
    if (newest !== null && message.sequence <= newest.sequence) return;
    this.situation.newest = message;
    this.situation.numbers = received;
    if (received) this.sceneAge.image(received.snapshot.image_number, received.capturedAtMs);
  }

  private markReceived(): number {
    return (this.situation.lastReceivedAtMs = this.now());
  }

  private forget(): void {
    this.generation += 1;
    this.situation.newest = this.situation.numbers = this.situation.picture = null;
    this.situation.lastPictureAtMs = null;
    this.clock.forget();
    this.sceneAge.forget();
    this.load.forget();
  }

  private receivedImageFrom(message: LiveMessage, receivedAtMs: number): ReceivedImage | null {
    const { snapshot, headline, image_age_ms: ageMs } = message;
    if (snapshot === null || ageMs === null) return null;
    const capturedAtMs = this.clock.capturedAtMs(receivedAtMs, ageMs, snapshot.captured_at_s);
    return { snapshot, headline, capturedAtMs, receivedAtMs };
  }

  private withRecoveryDelay(verdict: NumbersVerdict, nowMs: number): NumbersVerdict {
    const old = !verdict.live && verdict.cause === "old";
    const isDelayed = this.recoveryDelay.isActive(old, nowMs);
    if (!isDelayed || !verdict.live) return verdict;
    return { live: false, cause: "old", unread: null, ageMs: verdict.ageMs };
  }
}
