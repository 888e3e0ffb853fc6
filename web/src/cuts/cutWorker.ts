// Cuts the volume in a worker, so that figures and alarms never wait for it.
import { drawCut } from "./cut";
import type { CutReply, ToCutWorker } from "./cutter";

let voxels: Extract<ToCutWorker, { kind: "volume" }>["voxels"] | null = null;

addEventListener("message", ({ data }: MessageEvent<ToCutWorker>) => {
  if (data.kind === "volume") {
    voxels = data.voxels;
    return;
  }
  const beganAtMs = performance.now();
  const reply: CutReply = { job: data.job, tookMs: 0, cuts: [] };
  const { spare } = data;
  for (const { name, grid } of voxels === null ? [] : data.cuts) {
    const bytes = grid.width_px * grid.height_px * 4;
    const index = spare.findIndex((one) => one.byteLength === bytes);
    const buffer = index < 0 ? new ArrayBuffer(bytes) : (spare.splice(index, 1)[0] ?? new ArrayBuffer(bytes));
    if (voxels !== null) drawCut(voxels, grid, data.grey, new Uint8ClampedArray(buffer));
    reply.cuts.push({ name, buffer });
  }
  reply.tookMs = performance.now() - beganAtMs;
  postMessage(reply, { transfer: reply.cuts.map((one) => one.buffer) });
});
