import type { ReactNode } from "react";

/** Small drawings of states without content. Lines in a 48 by 48 box. */
const LINES = {
  case: "M6 38V12h13l4 5h19v21zM6 22h36",
  camera: "M5 14h25v20H5zM30 21l13-6v18l-13-6M17 24m-5 0a5 5 0 1 0 10 0a5 5 0 1 0-10 0",
  marker: "M9 9h30v30H9zM17 17h14v14H17zM24 17v14",
  tool: "M8 40L26 22M29 8l11 11l-8 8l-11-11zM8 40l3-8",
  ct: "M14 6h28v28H14zM10 10H6v32h32v-4M28 20m-8 0a8 6 0 1 0 16 0a8 6 0 1 0-16 0",
  plan: "M24 12c10 0 16 6 16 14s-6 14-16 14S8 34 8 26s6-14 16-14zM24 12V5M40 6L27 31",
  registration:
    "M5 10a4 4 0 1 0 8 0a4 4 0 1 0-8 0M5 24a4 4 0 1 0 8 0a4 4 0 1 0-8 0M5 38a4 4 0 1 0 8 0a4 4 0 1 0-8 0M35 13a4 4 0 1 0 8 0a4 4 0 1 0-8 0M35 25a4 4 0 1 0 8 0a4 4 0 1 0-8 0M35 36a4 4 0 1 0 8 0a4 4 0 1 0-8 0M14 11l20 2M14 24l20 1M14 38l20-2",
  recording: "M5 11h38v26H5zM20 18l10 6l-10 6z",
  log: "M11 5h26v38H11zM17 14h14M17 22h14M17 30h8",
  people: "M18 20m-7 0a7 7 0 1 0 14 0a7 7 0 1 0-14 0M5 41c0-8 5-12 13-12s13 4 13 12M37 17v14M30 24h14",
  lost: "M6 20c10-9 26-9 36 0M13 28c6-6 16-6 22 0M24 37v1M8 42L40 6",
  rejected: "M24 6L44 41H4zM24 18v11M24 34v2",
} as const;

export type DrawingName = keyof typeof LINES;

/** Decorative: the sentence beside it has the content. */
export function Drawing({ name }: { name: DrawingName }): ReactNode {
  return (
    <svg className="drawing" viewBox="0 0 48 48" aria-hidden="true" focusable="false">
      <path d={LINES[name]} />
    </svg>
  );
}
