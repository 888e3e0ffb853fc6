// Puts the bull's-eye onto its drawing, past React's state. In mm, up is up.
import type { BullseyeMessage } from "../live/messages";
import type { Reading } from "../live/reading";
import { bullseyeGeometry, type Point } from "./bullseyeGeometry";
import { figureOf } from "./limits";

const CROSS_MM = 0.8;
const SQUARE_MM = 0.45;
const WALL_MM = 1.1;
/** Of the reach; letters stand in the margin. */
const MARGIN = 1.14;
const LETTER = 0.12;
const TIP = 0.035;

/** Draws this view; with null, nothing of the last one is left. */
export function paintBullseye(
  svg: SVGSVGElement | null,
  along: BullseyeMessage | null,
  reading: Reading | null,
): void {
  if (svg === null) return;
  set(svg, "view", "visibility", along === null ? "hidden" : "visible");
  if (along === null || reading === null) return;
  frame(svg, along);
  const drawn = bullseyeGeometry(along);
  set(svg, "way", "d", drawn.way === null ? "" : line(drawn.way));
  set(svg, "end", "d", drawn.end === null ? "" : closed(square(drawn.end)));
  set(svg, "ellipse", "d", drawn.ellipse === null ? "" : closed(drawn.ellipse));
  set(svg, "arrow", "d", drawn.arrow === null ? "" : line(drawn.arrow));
  set(svg, "wall", "d", drawn.nearest === null || drawn.tip === null ? "" : bar(drawn.nearest, drawn.tip));
  set(svg, "wall", "data-standing", figureOf(reading, "wall").status);
  circle(svg, "drill", drawn.tip, along.drill_radius_mm);
  circle(svg, "tip", drawn.tip, TIP * along.reach_mm);
}

/** What does not move with the drill. */
function frame(svg: SVGSVGElement, along: BullseyeMessage): void {
  const reach = along.reach_mm;
  const half = MARGIN * reach;
  const box = `${-half} ${-half} ${2 * half} ${2 * half}`;
  if (svg.getAttribute("viewBox") === box && part(svg, "channel")?.getAttribute("r")) return;
  svg.setAttribute("viewBox", box);
  svg.style.setProperty("--eye", String(reach / 100));
  circle(svg, "border", [0, 0], reach);
  circle(svg, "channel", [0, 0], along.channel_radius_mm);
  set(svg, "axis", "d", `M${-CROSS_MM} 0H${CROSS_MM}M0 ${-CROSS_MM}V${CROSS_MM}`);
  const size = LETTER * reach;
  letter(svg, "left", -half + 0.5 * size, 0.35 * size, size);
  letter(svg, "right", half - 0.5 * size, 0.35 * size, size);
  letter(svg, "head", 0, -half + 0.9 * size, size);
}

function part(svg: SVGSVGElement, name: string): Element | null {
  return svg.querySelector(`[data-part=${name}]`);
}

function set(svg: SVGSVGElement, name: string, attribute: string, value: string): void {
  const element = part(svg, name);
  if (element && element.getAttribute(attribute) !== value) element.setAttribute(attribute, value);
}

function circle(svg: SVGSVGElement, name: string, at: Point | null, radius: number): void {
  set(svg, name, "r", at === null ? "0" : fixed(radius));
  if (at === null) return;
  set(svg, name, "cx", fixed(at[0]));
  set(svg, name, "cy", fixed(-at[1]));
}

function letter(svg: SVGSVGElement, name: string, x: number, y: number, size: number): void {
  set(svg, name, "x", fixed(x));
  set(svg, name, "y", fixed(y));
  set(svg, name, "font-size", fixed(size));
}

function line(places: readonly Point[]): string {
  return `M${places.map(([x, y]) => `${fixed(x)} ${fixed(-y)}`).join("L")}`;
}

function closed(places: readonly Point[]): string {
  return `${line(places)}Z`;
}

function square([x, y]: Point): Point[] {
  return [
    [x - SQUARE_MM, y - SQUARE_MM],
    [x + SQUARE_MM, y - SQUARE_MM],
    [x + SQUARE_MM, y + SQUARE_MM],
    [x - SQUARE_MM, y + SQUARE_MM],
  ];
}

/** A short bar across the way from the tip to the place that is nearest to a wall. */
function bar(nearest: Point, tip: Point): string {
  const [x, y] = [nearest[0] - tip[0], nearest[1] - tip[1]];
  const away = Math.hypot(x, y);
  if (away < 1e-6) return "";
  const [right, up] = [(-y / away) * WALL_MM, (x / away) * WALL_MM];
  return line([
    [nearest[0] - right, nearest[1] - up],
    [nearest[0] + right, nearest[1] + up],
  ]);
}

function fixed(value: number): string {
  return value.toFixed(3);
}
