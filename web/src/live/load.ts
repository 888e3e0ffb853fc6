// Capacity of this page: measured per image, reported as what is slow, and limited by the budget.
import type { Limits } from "./assess";
import { BudgetControl, budgetSteps, strainIn, UNLIMITED, type DrawingBudget } from "./budget";
import { PictureDeliveryMonitor, type PictureDelivery, type PictureChoice } from "./pictureDelivery";
import { SceneSwitch } from "./sceneSwitch";
import { ImageTimer } from "./imageTimer";
import { Stall, TimingWindow, type ImageTimes } from "./timings";

/** The longest interval between updates when nothing blocks the page. */
export const UPDATE_EVERY_MS = 50;

/** For lack of space the picture is reduced only to this width, so that an enlarged page stays recognisable. */
const MIN_HALF_WIDTH_PX = 640;

export class Load {
  readonly deliveryMonitor = new PictureDeliveryMonitor();
  readonly sceneSwitch = new SceneSwitch();
  /** Size of the picture's area in screen pixels; null if unknown. */
  spacePx: readonly [number, number] | null = null;
  /** Whether the server runs on this machine: both share its processor, without a network in between. */
  sharesMachine = false;
  private readonly window = new TimingWindow();
  private readonly stall = new Stall(UPDATE_EVERY_MS);
  private readonly control = new BudgetControl();
  private isSceneShown = false;
  private steps: DrawingBudget[] = budgetSteps(0, false);
  private stepsFor = {
    staleAfterMs: 0,
    isSceneDrawn: false,
    sharedPictureStaleAfterMs: null as number | null,
  };
  private cameraPx: readonly [number, number] | null = null;
  private current = 0;

  constructor(private readonly now: () => number) {}

  set choice(choice: PictureChoice) {
    this.deliveryMonitor.choice = choice;
  }

  get choice(): PictureChoice {
    return this.deliveryMonitor.choice;
  }

  get budget(): DrawingBudget {
    return this.isHalfEnough ? { ...this.step, largestPicture: "half" } : this.step;
  }

  private get step(): DrawingBudget {
    return this.steps[this.current] ?? UNLIMITED;
  }

  /** Whether a half-size picture still has a pixel per screen pixel. */
  private get isHalfEnough(): boolean {
    if (this.spacePx === null || this.cameraPx === null) return false;
    const [width, height] = this.cameraPx;
    const scale = Math.min(this.spacePx[0] / width, this.spacePx[1] / height);
    return scale <= 0.5 && width / 2 >= MIN_HALF_WIDTH_PX;
  }

  tick(nowMs: number): void {
    this.stall.tick(nowMs);
  }

  /** Records how long the screen took for an image. */
  screenImage(atMs: number, intervalMs: number): void {
    this.window.screen(atMs, intervalMs);
  }

  /** Records the reception of an image. */
  begin(receivedAtMs: number): ImageTimer {
    return new ImageTimer(this.now, this.stall, receivedAtMs);
  }

  /** Declares a visible pane with the 3-D scene, until the returned function is called. */
  showScene(): () => void {
    this.isSceneShown = true;
    return () => {
      this.isSceneShown = false;
    };
  }

  sceneDrawn(byProcessor: boolean, nowMs: number): void {
    if (byProcessor) this.control.sceneDrawnByProcessor(this.steps, nowMs);
  }

  shown(times: ImageTimes, of: { width_px: number; height_px: number }, scaleRatio: number): void {
    this.cameraPx = [of.width_px, of.height_px];
    this.window.image(times);
    this.deliveryMonitor.recordPicture(times.atMs, [of.width_px, of.height_px], scaleRatio);
  }

  forget(): void {
    this.window.forget();
    this.deliveryMonitor.forget();
  }

  update(nowMs: number, limits: Limits, cameraHz: number): PictureDelivery {
    this.chooseSteps(nowMs, limits);
    const timings = this.window.means(nowMs, this.control.sinceMs);
    const ageLimitMs = this.sharesMachine ? limits.pose_stale_after_ms : null;
    this.sceneSwitch.update(nowMs, this.window, this.control.isSceneDrawnByProcessor ? ageLimitMs : null);
    const strain = strainIn(this.step, timings, ageLimitMs);
    this.current = this.control.update(nowMs, this.steps, timings, strain);
    return this.deliveryMonitor.update(nowMs, cameraHz, this.window.means(nowMs), {
      largestPicture: this.step.largestPicture,
      neededRatio: this.isHalfEnough ? 0.5 : 1,
      sharesMachine: this.sharesMachine,
    });
  }

  private chooseSteps(nowMs: number, limits: Limits): void {
    const staleAfterMs = limits.scene_stale_after_ms;
    const isSceneDrawn = this.isSceneShown && this.sceneSwitch.isOn;
    const sharedPictureStaleAfterMs = this.sharesMachine ? limits.video_stale_after_ms : null;
    const { stepsFor } = this;
    if (
      stepsFor.staleAfterMs === staleAfterMs &&
      stepsFor.isSceneDrawn === isSceneDrawn &&
      stepsFor.sharedPictureStaleAfterMs === sharedPictureStaleAfterMs
    ) {
      return;
    }
    const steps = budgetSteps(staleAfterMs, isSceneDrawn, sharedPictureStaleAfterMs);
    this.control.setSteps(this.steps, steps, nowMs);
    this.steps = steps;
    this.stepsFor = { staleAfterMs, isSceneDrawn, sharedPictureStaleAfterMs };
  }
}
