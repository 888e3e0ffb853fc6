import { Alert, Button } from "@mantine/core";
import { useElementSize, useMergedRef } from "@mantine/hooks";
import {
  useEffect,
  useLayoutEffect,
  useRef,
  type KeyboardEvent,
  type ReactNode,
  type RefObject,
} from "react";
import { Rejection } from "../../../rest/client";
import { RejectionNote } from "../../../rest/RejectionNote";
import { useTexts } from "../../../texts/TextsContext";
import { addressOf, neighboursOf, type PlaneName } from "./address";
import { OtherCt } from "./loadSlice";
import { withTap } from "./measure";
import { SliceLabels } from "./SliceLabels";
import { frameOf, planeFromLps, type Vec2 } from "./place";
import { projectionOf, type Projection } from "./projection";
import { useSlices } from "./SlicesContext";
import { useSlice } from "./useSlice";
import { useSliceGestures } from "./useSliceGestures";
import { showing, whole, zoomedAt, type Stage, type Zoom } from "./zoom";

interface SliceViewProps {
  plane: PlaneName;
  isLarge: boolean;
  /** Drawing over the slice, in pixels of the stage. */
  drawing: (projection: Projection) => ReactNode;
}

const KEY_STEPS = new Map([
  ["ArrowUp", -1],
  ["ArrowDown", 1],
  ["PageUp", -5],
  ["PageDown", 5],
]);

/** One slice with scrolling, zoom and taps. Its labels are its own position, not the requested one. */
export function SliceView({ plane, isLarge, drawing }: SliceViewProps): ReactNode {
  const texts = useTexts().plan.slices;
  const slices = useSlices();
  const { ct, look, zooms, setZoom, goTo, scroll, setGreys, lookAnew } = slices;
  const address = addressOf(plane, look, ct);
  const {
    requested: wanted,
    shown,
    problem,
    retry,
  } = useSlice(address, neighboursOf(plane, look, ct, isLarge ? 2 : 0));
  const canvas = useRef<HTMLCanvasElement>(null);
  const stage = useRef<HTMLDivElement>(null);
  const { ref, width, height } = useElementSize<HTMLDivElement>();
  const merged = useMergedRef(ref, stage);

  const size: Stage = { width, height };
  const place = shown?.slice.place ?? null;
  const frame = place === null ? null : frameOf(place);
  const isReady = frame !== null && width > 0 && height > 0;
  const fit = isReady ? whole(frame, size) : null;
  const zoom = isLarge && isReady ? (zooms[plane] ?? fit) : fit;
  const crossAt = place === null ? null : planeFromLps(place, look.cursor);
  const projection = place === null || zoom === null ? null : projectionOf(place, zoom, size);

  useFollowedCross(plane, isLarge, zoom, size, crossAt, look.cursor, setZoom);
  usePaintedSlice(canvas, shown?.slice.pixels ?? null, zoom, frame, size);
  useSliceGestures({
    stage,
    size,
    frame,
    zoom,
    hand: isLarge ? slices.hand : "scroll",
    greys: look.greys,
    onTap: (at: Vec2) => {
      if (projection === null) return;
      const point = projection.lpsAt(at);
      if (isLarge && slices.hand === "measure") slices.setMeasurement(withTap(slices.measurement, point));
      else goTo(point);
    },
    onScroll: (steps) => {
      scroll(plane, steps);
    },
    onZoom: (next) => {
      if (isLarge) setZoom(plane, next);
    },
    onGreys: setGreys,
  });

  const { setLargePlace } = slices;
  useEffect(() => {
    if (isLarge) setLargePlace(place);
  }, [isLarge, place, setLargePlace]);

  const onKeyDown = (event: KeyboardEvent): void => {
    const steps = KEY_STEPS.get(event.key);
    const factor = event.key === "+" ? 1.25 : event.key === "-" ? 0.8 : null;
    if (steps !== undefined && !event.shiftKey) scroll(plane, steps);
    else if (factor !== null && zoom !== null && frame !== null) {
      setZoom(plane, zoomedAt(zoom, size, frame, [width / 2, height / 2], factor));
    } else return;
    event.preventDefault();
  };

  const isLate = shown !== null && shown.key !== wanted;
  return (
    <div
      className="slice-stage"
      data-plane={plane}
      data-late={isLate || undefined}
      data-testid={`slice-${plane}`}
      ref={merged}
      role="application"
      aria-label={texts.viewLabel[plane]}
      aria-roledescription={texts.viewRole}
      tabIndex={0}
      onKeyDown={onKeyDown}
    >
      <canvas ref={canvas} aria-hidden="true" />
      {projection !== null && (
        <svg width={width} height={height} focusable={false}>
          {drawing(projection)}
        </svg>
      )}
      {projection !== null && shown !== null && (
        <SliceLabels
          plane={plane}
          projection={projection}
          address={shown.key}
          isLate={isLate}
          isLarge={isLarge}
        />
      )}
      {problem instanceof OtherCt && (
        <Alert className="consequence slice-problem" title={texts.otherCt}>
          <Button size="lg" data-testid="look-at-other-ct" onClick={lookAnew}>
            {texts.lookAtOther}
          </Button>
        </Alert>
      )}
      {problem instanceof Rejection && (
        <div className="slice-problem">
          <RejectionNote rejection={problem} />
          <Button size="lg" onClick={retry}>
            {texts.again}
          </Button>
        </div>
      )}
      {shown === null && problem === null && <p className="slice-waiting">{texts.waiting}</p>}
    </div>
  );
}

/** The view follows the cross when it leaves the picture; it stays where the user moves it. */
function useFollowedCross(
  plane: PlaneName,
  isLarge: boolean,
  zoom: Zoom | null,
  size: Stage,
  crossAt: Vec2 | null,
  cursor: readonly number[],
  setZoom: (plane: PlaneName, zoom: Zoom) => void,
): void {
  const followed = useRef("");
  useEffect(() => {
    const key = `${plane} ${cursor.join(" ")}`;
    if (!isLarge || zoom === null || crossAt === null || followed.current === key) return;
    followed.current = key;
    const next = showing(zoom, size, crossAt, 0.06);
    if (next !== zoom) setZoom(plane, next);
  });
}

/** Draws in the same frame in which the labels change, so that both are always of one slice. */
function usePaintedSlice(
  canvas: RefObject<HTMLCanvasElement | null>,
  pixels: ImageBitmap | null,
  zoom: Zoom | null,
  frame: ReturnType<typeof frameOf> | null,
  size: Stage,
): void {
  useLayoutEffect(() => {
    if (canvas.current !== null) paint(canvas.current, pixels, zoom, frame, size);
  });
}

function paint(
  canvas: HTMLCanvasElement,
  pixels: ImageBitmap | null,
  zoom: Zoom | null,
  frame: ReturnType<typeof frameOf> | null,
  size: Stage,
): void {
  const ratio = window.devicePixelRatio;
  canvas.width = Math.round(size.width * ratio);
  canvas.height = Math.round(size.height * ratio);
  if (pixels === null || zoom === null || frame === null) return;
  const k = zoom.pxPerMm * ratio;
  canvas
    .getContext("2d")
    ?.drawImage(
      pixels,
      canvas.width / 2 + (frame.x - zoom.centre[0]) * k,
      canvas.height / 2 + (frame.y - zoom.centre[1]) * k,
      frame.width * k,
      frame.height * k,
    );
}
