// Orders cuts of the newest pose from the worker: one at a time, without a queue, at the rate that the page's budget and
// the duration of cuts allow. Pure except for the injected port.
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
      /** Buffers of earlier cuts, for reuse. */
      spare: ArrayBuffer[];
    };

export interface CutReply {
  job: number;
  tookMs: number;
  cuts: { name: CutName; buffer: ArrayBuffer }[];
}

/** Subject of the cuts: the drill of one image, or the plan without a drill. */
export interface CutSubject {
  kind: "live" | "plan";
  imageNumber: number;
  /** On the page's clock. */
  capturedAtMs: number;
  pose: Pose;
  channel: ChannelMessage;
}

/** The pixels of a pane, and their distance ahead of the tip. */
export interface Wanted {
  grid: PixelGrid;
  aheadMm: number;
}

/** A finished cut: pixels, plane and subject. */
export interface Cut extends Wanted {
  subject: CutSubject;
  buffer: ArrayBuffer;
}

/** A pane that shows a cut. */
interface CutViewer {
  name: CutName;
  /** The plane to cut for this pose; null while the pane has no size. */
  gridFor: (pose: Pose) => Wanted | null;
  show: (cut: Cut) => void;
}

type Post = (message: ToCutWorker, transfer: ArrayBuffer[]) => void;

/** A plan does not move. */
const PLAN_INTERVAL_MS = 500;
/** Share of one core for cuts. */
const MAX_SHARE = 0.15;
const MAX_SPARE = 8;

export class Cutter {
  private readonly viewers = new Set<CutViewer>();
  private job = 0;
  private orderedAtMs = -Infinity;
  /** Time between orders that keeps the worker within its share. */
  private restMs = 0;
  private ordered: {
    subject: CutSubject;
    of: Map<CutViewer, Wanted>;
  } | null = null;
  private spare: ArrayBuffer[] = [];
  private post: Post | null = null;
  /** The worker's volume; a pose of another CT is never cut from it. */
  private ctId: string | null = null;

  /** Sets the port of the worker; null without a worker. */
  connect(post: Post | null): void {
    this.post = post;
    this.ordered = null;
    this.ctId = null;
  }

  setVolume({ ctId, voxels }: { ctId: string; voxels: Voxels }): void {
    this.ctId = ctId;
    this.post?.({ kind: "volume", voxels }, [voxels.hu.buffer as ArrayBuffer]);
    // Pending replies belong to another volume.
    this.job += 1;
    this.ordered = null;
  }

  add(viewer: CutViewer): () => void {
    this.viewers.add(viewer);
    return () => this.viewers.delete(viewer);
  }

  /**
   * Orders cuts of this subject if the worker is idle and the interval has passed; otherwise a later call does, with a
   * newer pose. `intervalMs` is the shortest time between orders while the drill moves.
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

  /** Receives the worker's reply. */
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
