import type { ReactNode } from "react";

/** Icons are drawn, since many fonts lack these characters. Lines in a 24 by 24 box. */
const LINES = {
  crosshair: "M12 2v6M12 16v6M2 12h6M16 12h6M18 12a6 6 0 1 1-12 0a6 6 0 0 1 12 0",
  enlarge: "M14 4h6v6M20 4l-7 7M10 20H4v-6M4 20l7-7",
  point: "M12 8a4 4 0 1 1 0 8a4 4 0 0 1 0-8zM12 11v2M11 12h2",
  pen: "M4 20l1-5L16 4l4 4L9 19zM13 7l4 4",
  arrow: "M5 19L19 5M9 5h10v10",
  circle: "M21 12a9 9 0 1 1-18 0a9 9 0 0 1 18 0",
  undo: "M8 4L3 9l5 5M3 9h11a6 6 0 0 1 0 12h-4",
  redo: "M16 4l5 5l-5 5M21 9H10a6 6 0 0 0 0 12h4",
  turnLeft: "M4 4v6h6M4.5 10A8.5 8.5 0 1 1 4 15",
  turnRight: "M20 4v6h-6M19.5 10A8.5 8.5 0 1 0 20 15",
  sun: "M16 12a4 4 0 1 1-8 0a4 4 0 0 1 8 0M12 2v3M12 19v3M2 12h3M19 12h3M5 5l2 2M17 17l2 2M5 19l2-2M17 7l2-2",
  moon: "M20 14.5A8.5 8.5 0 1 1 9.5 4A7 7 0 0 0 20 14.5z",
  cross: "M5 5l14 14M19 5L5 19",
} as const;

type IconName = keyof typeof LINES;

/** An icon as large as the adjacent text. Decorative: its button carries the label. */
export function Icon({ name }: { name: IconName }): ReactNode {
  return (
    <svg className="icon" viewBox="0 0 24 24" aria-hidden="true" focusable="false">
      <path d={LINES[name]} />
    </svg>
  );
}
