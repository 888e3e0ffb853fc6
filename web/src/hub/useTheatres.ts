import { useEffect, useState } from "react";
import { getTheatres } from "../api";
import { SleepDetector } from "../live/sleepDetector";
import { Rejection, type Problem } from "../rest/client";
import type { Heard } from "./heard";
import { OWN_SERVER } from "./openedTheatre";

const ASK_EVERY_MS = 500;
const ASK_TIMEOUT_MS = 2000;
const SHOW_EVERY_MS = 250;

interface Theatres {
  /** The last answer; null before the first one, and after the page was hidden. */
  heard: Heard | null;
  /** Why the hub rejected the last question; null otherwise. */
  problem: Problem | null;
  nowMs: number;
}

/** Asks the hub for the theatres twice a second, and counts their ages by this page's clock. */
export function useTheatres(): Theatres {
  const [heard, setHeard] = useState<Heard | null>(null);
  const [problem, setProblem] = useState<Problem | null>(null);
  const [nowMs, setNowMs] = useState(() => performance.now());
  useEffect(() => {
    const stop = new AbortController();
    let timer: ReturnType<typeof setTimeout> | undefined;
    const ask = async (): Promise<void> => {
      const askedAtMs = performance.now();
      try {
        const signal = AbortSignal.any([stop.signal, AbortSignal.timeout(ASK_TIMEOUT_MS)]);
        const message = await getTheatres({ ...OWN_SERVER, signal });
        // A hidden page shows nothing, so that nothing old is visible on return.
        if (document.visibilityState === "visible") setHeard({ message, askedAtMs });
        setProblem(null);
      } catch (error) {
        if (error instanceof Rejection && error.status !== null) setProblem(error.problem);
      }
      if (!stop.signal.aborted) timer = setTimeout(() => void ask(), ASK_EVERY_MS);
    };
    void ask();
    const sleep = new SleepDetector(Date.now, () => performance.now());
    const ticking = setInterval(() => {
      if (sleep.hasSlept()) setHeard(null);
      setNowMs(performance.now());
    }, SHOW_EVERY_MS);
    document.addEventListener(
      "visibilitychange",
      () => {
        if (document.visibilityState === "hidden") setHeard(null);
      },
      { signal: stop.signal },
    );
    return () => {
      stop.abort();
      clearTimeout(timer);
      clearInterval(ticking);
    };
  }, []);
  return { heard, problem, nowMs };
}
