// The way from the live state into React: words and tables a few times a second, and at once when what they
// say changes. Picture and figures do not come this way; they are painted directly.
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
import type { Carried } from "./carried";
import type { Ages, View } from "./live";
import { Live } from "./live";
import { start, type Dashboard } from "./start";

const REFRESH_EVERY_MS = 250;

interface LiveValue {
  live: Live;
  view: View;
  dashboard: Dashboard | null;
}

const LiveContext = createContext<LiveValue | null>(null);

export function LiveProvider({ children }: { children: ReactNode }): ReactNode {
  const [live] = useState(() => new Live(() => performance.now()));
  const [view, setView] = useState(() => live.look());
  const [dashboard, setDashboard] = useState<Dashboard | null>(null);
  const shown = useRef({ key: "", atMs: -Infinity });

  useEffect(() => {
    const leave = live.onLook((next) => {
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
  if (value === null) throw new Error("useLive stands outside LiveProvider");
  return value;
}

/** The true age of everything, a few times a second: for who watches from afar. */
export function useAges(): Ages {
  return useLive().view.ages;
}

/** What this viewer's line carries, a few times a second. */
export function useCarried(): Carried {
  return useLive().view.carried;
}

/** Paints directly with every look, past React's state, and at once before what is new is seen. */
export function usePainter(paint: (view: View) => void): void {
  const { live } = useLive();
  const onLook = useEffectEvent(paint);
  useLayoutEffect(() => {
    const leave = live.onLook((view) => {
      onLook(view);
    });
    live.look();
    return leave;
  }, [live]);
}

/** What the words say; a change of it is shown at once. */
function keyOf({ link, firstMessage, video, numbers, scene, newest, carried }: View): string {
  const videoKey = video.live ? "live" : video.cause;
  const unread = numbers.live ? null : numbers.unread;
  const numbersKey = numbers.live
    ? "live"
    : `${numbers.cause} ${unread?.headline.title.en ?? ""} ${unread?.headline.detail.en ?? ""}`;
  const problems = `${newest?.source.problem?.code ?? ""} ${newest?.process.problem?.code ?? ""}`;
  return [
    link,
    firstMessage,
    videoKey,
    numbersKey,
    scene.state,
    problems,
    newest?.source.state,
    newest?.alarms.revision,
    carried.choice,
  ].join("|");
}
