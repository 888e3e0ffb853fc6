import { useDrag } from "@use-gesture/react";
import { useRef, type KeyboardEvent, type ReactNode } from "react";
import { formatNumber } from "../../../live/rounding";
import type { Projection } from "../slices/projection";
import { plus, minus, type Vec3 } from "../slices/vectors";
import { knobAt } from "./knobs";

/** Size for a gloved finger. */
const TOUCH_RADIUS_PX = 28;
/** The knob is beside its point, so that the finger does not hide it. */
const KNOB_AWAY_PX = 46;
const STEP_MM = 0.5;
const KEYS = new Map<string, readonly [number, number]>([
  ["ArrowLeft", [-1, 0]],
  ["ArrowRight", [1, 0]],
  ["ArrowUp", [0, -1]],
  ["ArrowDown", [0, 1]],
]);

interface HandleProps {
  projection: Projection;
  point: Vec3;
  /** Direction of the knob in pixels; its length is ignored. */
  towards: readonly [number, number];
  label: string;
  name: string;
  /** Drawn in the knob, around (0, 0), to tell it from others; an SVG path. */
  sign?: string | undefined;
  onMove: (point: Vec3) => void;
}

/** A point that is dragged by a knob beside it; it moves relative to its start. */
export function Handle({ projection, point, towards, label, name, sign, onMove }: HandleProps): ReactNode {
  const knob = useRef<SVGGElement>(null);
  const [x, y] = projection.at(point);
  const [kx, ky] = knobAt([x, y], towards, projection.stage, {
    awayPx: KNOB_AWAY_PX,
    radiusPx: TOUCH_RADIUS_PX,
  });
  // The offset from the slice is preserved: only the in-plane position moves.
  const movedBy = (from: Vec3, dx: number, dy: number): Vec3 => {
    const [fx, fy] = projection.at(from);
    const shift = minus(projection.lpsAt([fx + dx, fy + dy]), projection.lpsAt([fx, fy]));
    return plus(from, shift);
  };
  useDrag(
    ({ movement: [dx, dy], memo, first, event }) => {
      event.stopPropagation();
      const from = first ? point : ((memo as Vec3 | undefined) ?? point);
      if (dx !== 0 || dy !== 0) onMove(movedBy(from, dx, dy));
      return from;
    },
    { target: knob, pointer: { keys: false, capture: true }, eventOptions: { passive: false } },
  );
  const onKeyDown = (event: KeyboardEvent): void => {
    const step = KEYS.get(event.key);
    if (step === undefined) return;
    event.preventDefault();
    event.stopPropagation();
    const px = STEP_MM * projection.pxPerMm;
    onMove(movedBy(point, step[0] * px, step[1] * px));
  };
  return (
    <g
      ref={knob}
      className="draw-handle"
      data-handle={name}
      data-testid={`handle-${name}`}
      role="slider"
      aria-label={label}
      aria-valuetext={point.map((one) => formatNumber(one)).join(", ")}
      aria-valuenow={0}
      tabIndex={0}
      onKeyDown={onKeyDown}
    >
      <line x1={x} y1={y} x2={kx} y2={ky} />
      <circle className="draw-handle-touch" cx={kx} cy={ky} r={TOUCH_RADIUS_PX} />
      <circle className="draw-handle-knob" cx={kx} cy={ky} r={14} />
      {sign !== undefined && <path d={sign} transform={`translate(${kx} ${ky})`} />}
      <circle className="draw-handle-point" cx={x} cy={y} r={4} />
    </g>
  );
}
