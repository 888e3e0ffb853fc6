// Orders cuts of the newest pose from the worker: one at a time, without a queue, as often as the page's budget allows,
// and less often where they take long. Pure but for the port that it is given; times go in as numbers.
import type { ChannelMessage } from "../live/messages";
import type { PixelGrid } from "../operator/plan/slices/place";
import type { GreyWindow, Voxels } from "./cut";
import type { CutName, Pose } from "./planes";

export type ToCutWorker =
  | { kind: "volume"; voxels: Voxels }
  | {
      kind: "cut";
      job: number;
      grey: GreyWindow;
      cuts: { name: CutName; grid: PixelGrid }[];
      /** Buffers of earlier cuts, given back to be written again. */
      spare: ArrayBuffer[];
    };

export interface CutReply {
  job: number;
  tookMs: number;
  cuts: { name: CutName; buffer: ArrayBuffer }[];
}

/** What the cuts are made for: the drill of one image, or the plan while there is none. */
export interface CutSubject {
  kind: "live" | "plan";
  imageNumber: number;
  /** On the page's clock. */
  capturedAtMs: number;
  pose: Pose;
  channel: ChannelMessage;
}

/** The pixels that a pane wants, and how far ahead of the tip they lie. */
export interface Wanted {
  grid: PixelGrid;
  aheadMm: number;
}

/** A finished cut: its pixels, where they lie, and what it was made for. */
export interface Cut extends Wanted {
  subject: CutSubject;
  buffer: ArrayBuffer;
}

/** A pane that shows a cut. */
export interface CutViewer {
  name: CutName;
  /** The pixels to cut for this pose, or null while the pane has no size. */
  gridFor: (pose: Pose) => Wanted | null;
  show: (cut: Cut) => void;
}

type Post = (message: ToCutWorker, transfer: ArrayBuffer[]) => void;

/** A plan does not move. */
const PLAN_INTERVAL_MS = 500;
/** The share of one core that cuts may take. */
const MAX_SHARE = 0.15;
const MAX_SPARE = 8;

export class Cutter {
  private readonly viewers = new Set<CutViewer>();
  private job = 0;
  private orderedAtMs = -Infinity;
  /** From one order to the next, for the worker not to take more than its share. */
  private restMs = 0;
  private ordered: {
    subject: CutSubject;
    of: Map<CutViewer, Wanted>;
  } | null = null;
  private spare: ArrayBuffer[] = [];
  private post: Post | null = null;
  /** Of the volume that the worker has; a pose of another CT is never cut from it. */
  private ctId: string | null = null;

  /** From now on the worker is reached by this; null while there is none. */
  connect(post: Post | null): void {
    this.post = post;
    this.ordered = null;
    this.ctId = null;
  }

  setVolume({ ctId, voxels }: { ctId: string; voxels: Voxels }): void {
    this.ctId = ctId;
    this.post?.({ kind: "volume", voxels }, [voxels.hu.buffer as ArrayBuffer]);
    // What is still on its way was cut from another volume.
    this.job += 1;
    this.ordered = null;
  }

  add(viewer: CutViewer): () => void {
    this.viewers.add(viewer);
    return () => this.viewers.delete(viewer);
  }

  /**
   * Orders cuts of this subject if the worker is idle and it is time; a later call has a newer one. `intervalMs` is the
   * least time from one order to the next while the drill moves.
   */
  update(nowMs: number, subject: CutSubject | null, grey: GreyWindow, intervalMs: number): void {
    if (this.post === null || subject === null || this.ordered !== null) return;
    const wantedMs = subject.kind === "live" ? intervalMs : PLAN_INTERVAL_MS;
    if (nowMs < this.orderedAtMs + Math.max(wantedMs, this.restMs)) return;
    if (this.ctId === null || subject.channel.ct_id !== this.ctId) return;
    const of = new Map<CutViewer, Wanted>();
    for (const viewer of this.viewers) {
      const wanted = viewer.gridFor(subject.pose);
      if (wanted !== null) of.set(viewer, wanted);
    }
    if (of.size === 0) return;
    this.ordered = { subject, of };
    this.orderedAtMs = nowMs;
    this.job += 1;
    const cuts = [...of].map(([{ name }, { grid }]) => ({ name, grid }));
    this.post({ kind: "cut", job: this.job, grey, cuts, spare: this.spare }, this.spare);
    this.spare = [];
  }

  /** Takes the worker's reply. */
  receive({ job, tookMs, cuts }: CutReply): void {
    if (job !== this.job || this.ordered === null) return;
    const { subject, of } = this.ordered;
    this.ordered = null;
    this.restMs = tookMs / MAX_SHARE;
    for (const { name, buffer } of cuts) {
      const [viewer, wanted] = [...of].find(([one]) => one.name === name) ?? [];
      if (viewer === undefined || wanted === undefined) continue;
      if (this.viewers.has(viewer)) viewer.show({ subject, ...wanted, buffer });
      if (this.spare.length < MAX_SPARE) this.spare.push(buffer);
    }
  }
}
