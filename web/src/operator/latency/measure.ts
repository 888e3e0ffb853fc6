// Runs a measurement: paints codes, records what the page displays, and sends it to the server for evaluation.
import type { Live } from "../../live/live";
import { Rejection } from "../../rest/client";
import {
  getLatencyMeasurement,
  type LatencyCodesMessage,
  type LatencyReadingMessage,
  type LatencyResultMessage,
  postLatencyMeasurementConclusion,
} from "../../api";
import { CodeSequence } from "./codes";
import { drawCode } from "./drawCode";
import { LatencyNotes } from "./notes";

export type Plan = LatencyCodesMessage;
export type Result = LatencyResultMessage;
type Reading = LatencyReadingMessage;

export interface Progress {
  lookedImages: number;
  readImages: number;
  doneRatio: number;
}

interface Measured {
  live: Live;
  plan: Plan;
  canvas: HTMLCanvasElement;
  madeBy: string;
  signal: AbortSignal;
  onProgress: (progress: Progress) => void;
}

const ASK_EVERY_MS = 500;
/** Time to aim the camera; after that the server reports how many images it could not read. */
const AIM_WITHIN_MS = 60_000;
/** Time for images of the last code to arrive. */
const LINGER_MS = 1500;

/**
 * Returns the result, or null if stopped by `signal`.
 *
 * @throws Rejection
 */
export async function measure(measured: Measured): Promise<Result | null> {
  const { live, plan, madeBy, signal, onProgress } = measured;
  const sequence = new CodeSequence(plan, Math.random);
  const notes = new LatencyNotes();
  const beganAtMs = performance.now();
  live.onShown = (image) => {
    notes.draw(image);
  };
  const stopPainting = paintEachFrame(measured, sequence, notes);
  try {
    let overAtMs = Infinity;
    while (performance.now() < overAtMs) {
      await later(ASK_EVERY_MS);
      if (signal.aborted) return null;
      const reading = await fetchResult(notes);
      if (reading.problem !== null) throw new Rejection(reading.problem);
      if (reading.read_images > 0 && !sequence.isCounting) {
        notes.begin();
        sequence.begin();
      }
      const gaveUp = !sequence.isCounting && performance.now() - beganAtMs > AIM_WITHIN_MS;
      if (sequence.isOver) overAtMs = Math.min(overAtMs, performance.now() + LINGER_MS);
      if (gaveUp) overAtMs = 0;
      const { examined_images: lookedImages, read_images: readImages } = reading;
      onProgress({ lookedImages, readImages, doneRatio: sequence.doneRatio });
    }
    const body = notes.conclusion(madeBy, innerWidth, innerHeight);
    return await postLatencyMeasurementConclusion({ body });
  } finally {
    live.onShown = null;
    stopPainting();
  }
}

function paintEachFrame({ plan, canvas }: Measured, sequence: CodeSequence, notes: LatencyNotes): () => void {
  let frame = 0;
  const onFrame = (): void => {
    // One refresh for code and picture, so that later delays of browser and screen are the same for both.
    const nowMs = performance.now();
    notes.frame(nowMs);
    const code = sequence.next(nowMs);
    if (code !== null) {
      drawCode(canvas, plan.patterns[code] ?? "", plan.cells);
      notes.paint(code, nowMs);
    }
    frame = requestAnimationFrame(onFrame);
  };
  frame = requestAnimationFrame(onFrame);
  return () => {
    cancelAnimationFrame(frame);
  };
}

async function fetchResult(notes: LatencyNotes): Promise<Reading> {
  const requestedAtMs = performance.now();
  const reading = await getLatencyMeasurement();
  notes.compare(requestedAtMs, performance.now(), reading.server_s);
  return reading;
}

function later(waitMs: number): Promise<void> {
  return new Promise((done) => {
    setTimeout(done, waitMs);
  });
}
