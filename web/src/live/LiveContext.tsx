// Connects the live state to React. Texts and tables update a few times a second, and at once when their content
// changes. Picture and figures are painted without React.
import {
  createContext,
  use,
  useEffect,
  useEffectEvent,
  useLayoutEffect,
  useRef,
  useState,
  type ReactNode,
} from "react";
import type { View } from "./live";
import { Live } from "./live";
import { start, type Dashboard } from "./start";
import { keyOf } from "./view";

const REFRESH_EVERY_MS = 250;

interface LiveValue {
  live: Live;
  view: View;
  dashboard: Dashboard | null;
}

const LiveContext = createContext<LiveValue | null>(null);

export function LiveProvider({ children }: { children: ReactNode }): ReactNode {
  const [live] = useState(() => new Live(() => performance.now()));
  const [view, setView] = useState(() => live.update());
  const [dashboard, setDashboard] = useState<Dashboard | null>(null);
  const shown = useRef({ key: "", atMs: -Infinity });

  useEffect(() => {
    const leave = live.onUpdate((next) => {
      const key = keyOf(next);
      if (key === shown.current.key && next.nowMs - shown.current.atMs < REFRESH_EVERY_MS) return;
      shown.current = { key, atMs: next.nowMs };
      setView(next);
    });
    const stop = start(live, setDashboard);
    return () => {
      leave();
      stop();
    };
  }, [live]);

  return <LiveContext value={{ live, view, dashboard }}>{children}</LiveContext>;
}

export function useLive(): LiveValue {
  const value = use(LiveContext);
  if (value === null) throw new Error("useLive must be used inside LiveProvider");
  return value;
}

/** Registers a painter that runs with every update, without React, and once before the new element is seen. */
export function usePainter(paint: (view: View) => void): void {
  const { live } = useLive();
  const onLook = useEffectEvent(paint);
  useLayoutEffect(() => {
    const leave = live.onUpdate((view) => {
      onLook(view);
    });
    live.update();
    return leave;
  }, [live]);
}
