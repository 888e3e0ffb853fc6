// The paper's "search time per image": the tracker's time for one image, without the server's stages.

const NOT_SEARCH = new Set([
  "waiting",
  "grab",
  "capture",
  "copy",
  "notice",
  "overlay",
  "encode",
  "navigation",
  "navigate",
]);

export function searchTimeMs(stageMs: Record<string, number>): number | null {
  const times = Object.entries(stageMs).filter(([stage]) => !NOT_SEARCH.has(stage));
  return times.length === 0 ? null : times.reduce((sum, [, ms]) => sum + ms, 0);
}
