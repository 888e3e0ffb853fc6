// Shared state of all CT views: cross, grey window, large plane.
import { createContext, use, useCallback, useMemo, useRef, useState, type ReactNode } from "react";
import {
  depthOf,
  FLAT,
  reachOf,
  scrolled,
  type Ct,
  type Greys,
  type Look,
  type PlaneName,
  type Way,
} from "./address";
import type { Measurement } from "./measure";
import type { Place } from "./place";
import type { Vec3 } from "./vectors";
import type { Zoom } from "./zoom";

export type Hand = "scroll" | "greys" | "move" | "measure";

interface SlicesValue {
  ct: Ct;
  /** The case has another CT: switches to it. */
  lookAnew: () => void;
  look: Look;
  /** The plane that is shown large. */
  plane: PlaneName;
  hand: Hand;
  zooms: Partial<Record<PlaneName, Zoom | null>>;
  measurement: Measurement;
  setMeasurement: (measurement: Measurement) => void;
  setPlane: (plane: PlaneName) => void;
  setHand: (hand: Hand) => void;
  setZoom: (plane: PlaneName, zoom: Zoom | null) => void;
  /** Moves the cross, and all planes with it. */
  goTo: (point: Vec3) => void;
  scroll: (plane: PlaneName, steps: number) => void;
  setGreys: (greys: Greys) => void;
  setWay: (way: Way | null) => void;
  /** Transform of the displayed large picture; written by it, read on a touch. */
  largePlace: () => Place | null;
  setLargePlace: (place: Place | null) => void;
}

const SlicesContext = createContext<SlicesValue | null>(null);

const BONE: Greys = { window_hu: 1800, level_hu: 400 };

interface SlicesProviderProps {
  ct: Ct;
  lookAnew: () => void;
  children: ReactNode;
}

export function SlicesProvider({ ct, lookAnew, children }: SlicesProviderProps): ReactNode {
  const [look, setLook] = useState<Look>(() => ({
    cursor: middleOf(ct),
    greys: ct.presets["bone"] ?? BONE,
    way: null,
    turnDeg: 0,
    depthMm: 0,
  }));
  const [plane, setPlane] = useState<PlaneName>("axial");
  const [hand, setHand] = useState<Hand>("scroll");
  const [zooms, setZooms] = useState<Partial<Record<PlaneName, Zoom | null>>>({});

  const [measurement, setMeasurement] = useState<Measurement>([]);

  const setZoom = useCallback((of: PlaneName, zoom: Zoom | null) => {
    setZooms((before) => ({ ...before, [of]: zoom }));
  }, []);
  const goTo = useCallback((point: Vec3) => {
    setLook((before) => ({
      ...before,
      cursor: point,
      depthMm: before.way === null ? before.depthMm : depthOf(before.way, point),
    }));
  }, []);
  const scroll = useCallback(
    (of: PlaneName, steps: number) => {
      setLook((before) => scrolled(of, before, ct, steps));
    },
    [ct],
  );
  const setGreys = useCallback((greys: Greys) => {
    setLook((before) => ({ ...before, greys }));
  }, []);
  const setWay = useCallback((way: Way | null) => {
    setLook((before) => ({ ...before, way }));
  }, []);

  const large = useRef<Place | null>(null);
  const largePlace = useCallback(() => large.current, []);
  const setLargePlace = useCallback((place: Place | null) => {
    large.current = place;
  }, []);

  const isOblique = plane === "along" || plane === "across";
  const shownPlane = isOblique && look.way === null ? "axial" : plane;
  const value = useMemo(
    () => ({
      ct,
      lookAnew,
      look,
      plane: shownPlane,
      hand,
      zooms,
      measurement,
      setMeasurement,
      setPlane,
      setHand,
      setZoom,
      goTo,
      scroll,
      setGreys,
      setWay,
      largePlace,
      setLargePlace,
    }),
    [
      ct,
      lookAnew,
      look,
      shownPlane,
      hand,
      zooms,
      measurement,
      setZoom,
      goTo,
      scroll,
      setGreys,
      setWay,
      largePlace,
      setLargePlace,
    ],
  );
  return <SlicesContext value={value}>{children}</SlicesContext>;
}

export function useSlices(): SlicesValue {
  const value = use(SlicesContext);
  if (value === null) throw new Error("useSlices must be used inside SlicesProvider");
  return value;
}

function middleOf(ct: Ct): Vec3 {
  const middle = Object.fromEntries(
    FLAT.map((plane) => {
      const { from_mm, to_mm, step_mm } = reachOf(plane, ct);
      return [plane, from_mm + Math.round((to_mm - from_mm) / 2 / step_mm) * step_mm];
    }),
  );
  return [middle["sagittal"] ?? 0, middle["coronal"] ?? 0, middle["axial"] ?? 0];
}
