import { useEffectEvent, useLayoutEffect, useRef, useState, type ReactNode } from "react";
import { useLive, usePainter } from "../live/LiveContext";
import type { View } from "../live/view";
import { formatNumber } from "../live/rounding";
import { frameOf, type PixelGrid } from "../operator/plan/slices/place";
import { rulerMm } from "../operator/plan/slices/zoom";
import { DisplayedCut } from "../marks/displayedCut";
import { MarksLayer } from "../marks/MarksLayer";
import { figureOf } from "../panes/limits";
import { clearBitmap } from "../panes/bitmapCanvas";
import { Pane } from "../panes/Pane";
import { PaintRateLimiter } from "../panes/paintRateLimiter";
import { setData, setText } from "../panes/setText";
import { paintSplit, Split } from "../panes/Split";
import { useTexts } from "../texts/TextsContext";
import { CutCover, NoVolumeNote } from "./CutCover";
import { useCuts } from "./CutsContext";
import type { Cut, Wanted } from "./cutter";
import { displayedDrill } from "./drill";
import { cutVerdict, type CutVerdict, type NoVolume, type VolumeState } from "./cutVerdict";
import { overlayOf, PARTS } from "./overlay";
import { drawPixels, paintOverlay } from "./paintCut";
import { cutGrid, fieldOf, type CutName, type Pose } from "./planes";

const AHEAD_MM = [0, 5, 10, 20];
const MAX_LABELS = 5;
const EDGES = ["left", "right", "top", "bottom"] as const;
const MAX_RULER_PX = 120;
/** Minimum size; a pane that is being laid out shows nothing. */
const MIN_STAGE_PX = 40;

interface CutPaneProps {
  name: CutName;
  /** Shown beside the title: other content for this tile. */
  tabs?: ReactNode;
  /** Shown over the picture: the choice of planes. */
  tools?: ReactNode;
}

/** A cut of the CT that follows the drill, with drill and plan to scale. */
export function CutPane({ name, tabs, tools }: CutPaneProps): ReactNode {
  const texts = useTexts();
  const { dashboard } = useLive();
  const { cutter, volume, aheadMm } = useCuts();
  const stage = useRef<HTMLDivElement>(null);
  const canvas = useRef<HTMLCanvasElement>(null);
  const svg = useRef<SVGSVGElement>(null);
  const stamp = useRef<HTMLParagraphElement>(null);
  const ruler = useRef<HTMLParagraphElement>(null);
  const split = useRef<HTMLDListElement>(null);
  const shown = useRef<Cut | null>(null);
  const size = useRef({ width: 0, height: 0 });
  const limiter = useRef(new PaintRateLimiter());
  const [marked] = useState(() => new DisplayedCut());
  /** Subject of the painted lines; empty if there are none. */
  const drawnFrom = useRef<readonly unknown[]>([]);
  const drawnAtMs = useRef(-Infinity);
  const ahead = name === "probe" ? aheadMm : 0;
  const limitMs = dashboard?.limits.scene_stale_after_ms ?? 500;
  const verdictOf = (now: View): CutVerdict =>
    cutVerdict(shown.current?.subject ?? null, {
      ...now,
      volume,
      limitMs,
      channel: now.newest?.snapshot?.channel ?? null,
    });
  const [verdict, setVerdict] = useState<CutVerdict>({ state: "covered", why: "connecting" });

  const gridFor = (pose: Pose): Wanted | null => {
    const { width, height } = size.current;
    if (width < MIN_STAGE_PX || height < MIN_STAGE_PX) return null;
    return { grid: cutGrid(name, pose, fieldOf(name, width, height), ahead), aheadMm: ahead };
  };

  /** The plane of the lines: that of the cut, or of the drill if there is no CT. */
  const drawnOn = (next: CutVerdict, { numbers }: View): (Wanted & { imageNumber: number }) | null => {
    const drill = displayedDrill(numbers);
    if (next.state === "bare" && numbers.live && drill !== null) {
      const wanted = gridFor(drill.pose);
      return wanted === null ? null : { ...wanted, imageNumber: numbers.imageNumber };
    }
    const cut = next.state === "covered" || next.state === "bare" ? null : shown.current;
    return cut === null
      ? null
      : { grid: cut.grid, aheadMm: cut.aheadMm, imageNumber: cut.subject.imageNumber };
  };

  useLayoutEffect(() => {
    const element = stage.current;
    if (element === null) return;
    const observer = new ResizeObserver(() => {
      size.current = { width: element.clientWidth, height: element.clientHeight };
    });
    observer.observe(element);
    return () => {
      observer.disconnect();
    };
  }, []);

  const onGrid = useEffectEvent(gridFor);
  useLayoutEffect(
    () =>
      cutter.add({
        name,
        gridFor: (pose) => onGrid(pose),
        show: (cut) => {
          if (canvas.current === null) return;
          drawPixels(canvas.current, cut);
          shown.current = cut;
        },
      }),
    [cutter, name],
  );

  usePainter((now) => {
    const next = verdictOf(now);
    if (wordsOf(next) !== wordsOf(verdict)) setVerdict(next);
    setData(stage.current, "live", String(next.state === "live" || next.state === "bare"));
    setData(stage.current, "shows", next.state);
    if (
      (next.state === "covered" || next.state === "bare") &&
      shown.current !== null &&
      canvas.current !== null
    ) {
      clearBitmap(canvas.current);
      shown.current = null;
    }
    if (svg.current === null) return;
    const drawn = drawnOn(next, now);
    const reading = drawn !== null && next.state !== "plan" && now.numbers.live ? now.numbers.reading : null;
    if (name === "probe") paintSplit(split.current, reading, texts);
    if (drawn === null) {
      paintOverlay(svg.current, null);
      marked.update(null);
      drawnFrom.current = [];
      setText(stamp.current, "");
      return;
    }
    // Lines are painted with their cut instead of with each message, since each change costs a screen refresh.
    const from = [next.state, shown.current, size.current, ahead];
    const isMovingAlone = next.state === "bare" && now.nowMs - drawnAtMs.current >= now.budget.cutIntervalMs;
    if (isMovingAlone || from.some((one, index) => one !== drawnFrom.current[index])) {
      drawnFrom.current = from;
      drawnAtMs.current = now.nowMs;
      const { grid } = drawn;
      marked.update(markedCut(grid, now));
      const overlay = overlayOf(name, grid, {
        channel: now.newest?.snapshot?.channel ?? null,
        drill: reading === null ? null : displayedDrill(now.numbers),
        aheadMm: drawn.aheadMm,
        maxOffsetMm: reading === null ? null : figureOf(reading, "entry").limit,
      });
      const { width } = size.current;
      paintOverlay(svg.current, { overlay, grid, widthPx: width });
      for (const edge of EDGES) setText(edgeOf(stage.current, edge), overlay.edges[edge]);
      paintRuler(ruler.current, width / frameOf(grid).width);
    }
    if (!limiter.current.isDue(now.nowMs, `${next.state} ${drawn.imageNumber}`)) return;
    const age = "ageMs" in next ? `${texts.video.age} ${formatNumber(next.ageMs, 0)} ms` : "";
    setText(stamp.current, age === "" ? "" : `${texts.video.image} ${drawn.imageNumber} · ${age}`);
  });

  const t = texts.theatre.cuts;
  const lacks = lackOf(verdict, volume);
  return (
    <Pane id={`cut-${name}`} title={t.title[name]} aside={tabs}>
      <div
        className="cut-stage"
        data-picture={name}
        data-testid={`cut-${name}`}
        data-live="false"
        data-shows="covered"
        ref={stage}
      >
        <canvas ref={canvas} width={1} height={1} role="img" aria-label={t.alt[name]} />
        <svg ref={svg} viewBox="0 0 1 1" preserveAspectRatio="none" aria-hidden="true">
          {PARTS.map((part) => (
            <path key={part} className={`cut-${part}`} data-part={part} />
          ))}
          {Array.from({ length: MAX_LABELS }, (_, index) => (
            <text key={index} />
          ))}
        </svg>
        {EDGES.map((edge) => (
          <span key={edge} className={`cut-edge cut-edge-${edge}`} data-edge={edge} />
        ))}
        <p className="cut-ruler" ref={ruler}>
          <span />
          <b />
        </p>
        <MarksLayer
          stage={marked}
          label={`${t.title[name]}. ${texts.marks.layerCut}`}
          testId={`marks-${name}`}
        />
        <p className="cut-stamp" data-testid={`cut-${name}-stamp`} ref={stamp} />
        <p className="cut-plan">{t.plan}</p>
        {name === "probe" ? (
          <DepthButtons />
        ) : (
          <div className="cut-buttons">
            {(name === "axial" || name === "anatomical-axial") && <WindowButton />}
            {tools}
          </div>
        )}
        <div className="when-stale" data-testid={`cut-${name}-cover`}>
          <CutCover verdict={verdict} />
        </div>
      </div>
      {lacks !== null && <NoVolumeNote volume={lacks} />}
      {name === "probe" && <Split ref={split} />}
    </Pane>
  );
}

/** What marks on a cut belong to; null without a CT. */
function markedCut(grid: PixelGrid, { newest }: View): Parameters<DisplayedCut["update"]>[0] {
  const snapshot = newest?.snapshot ?? null;
  const ctId = snapshot?.channel?.ct_id ?? null;
  if (snapshot === null || ctId === null) return null;
  const { image_number, captured_at_s } = snapshot;
  return { grid, ctId, moment: { image_number, captured_at_s } };
}

/** How far ahead of the tip the probe's eye is. */
function DepthButtons(): ReactNode {
  const t = useTexts().theatre.cuts;
  const { aheadMm, setAheadMm } = useCuts();
  return (
    <div className="cut-buttons" role="group" aria-label={t.ahead}>
      {AHEAD_MM.map((one) => (
        <button
          key={one}
          type="button"
          aria-pressed={one === aheadMm}
          data-testid={`ahead-${one}`}
          onClick={() => {
            setAheadMm(one);
          }}
        >
          {one === 0 ? t.tip : `+${one}`}
        </button>
      ))}
    </div>
  );
}

/** Switches to the next window. */
function WindowButton(): ReactNode {
  const texts = useTexts();
  const { windows, window, setWindow } = useCuts();
  const names = texts.plan.slices.preset;
  if (windows.length === 0) return null;
  return (
    <button
      type="button"
      data-testid="cut-window"
      aria-label={`${texts.theatre.cuts.window}: ${window}`}
      onClick={() => {
        setWindow(windows[(windows.indexOf(window) + 1) % windows.length] ?? window);
      }}
    >
      {window in names ? names[window as keyof typeof names] : window}
    </button>
  );
}

/** Why there is no CT; also while the cut is covered, so that an alarm does not change its size. */
function lackOf(verdict: CutVerdict, volume: VolumeState): NoVolume | null {
  if (verdict.state === "bare") return verdict.volume;
  const isKnown = volume.state !== "ready" && volume.state !== "loading";
  return verdict.state === "covered" && isKnown ? volume : null;
}

/** State that the cover's texts depend on. */
function wordsOf(verdict: CutVerdict): string {
  switch (verdict.state) {
    case "covered":
      return verdict.why;
    case "bare":
      return `bare ${verdict.volume.state}`;
    case "live":
    case "plan":
      return verdict.state;
  }
}

function edgeOf(stage: HTMLElement | null, edge: string): Element | null {
  return stage?.querySelector(`[data-edge=${edge}]`) ?? null;
}

function paintRuler(line: HTMLElement | null, pxPerMm: number): void {
  const bar = line?.querySelector("span");
  if (!bar) return;
  const lengthMm = rulerMm(pxPerMm, MAX_RULER_PX);
  const width = `${(lengthMm * pxPerMm).toFixed(1)}px`;
  if (bar.style.width !== width) bar.style.width = width;
  setText(line?.querySelector("b") ?? null, `${lengthMm} mm`);
}
