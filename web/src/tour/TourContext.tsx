import { createContext, use, useCallback, useMemo, useState, type ReactNode } from "react";
import { useLocation } from "wouter";
import { useSession } from "../app/session";
import { useLive } from "../live/LiveContext";
import { mayTour, STATIONS } from "./stations";
import { storeTourLeft, wasTourLeft } from "./storedTour";
import { TourCard } from "./TourCard";

export interface Tour {
  /** Index of the present station; null while no tour runs. */
  at: number | null;
  /** Whether the tour was left or ended in this browser. */
  wasLeft: boolean;
  /** Starts at 0, and continues at another station; opens its page. */
  show: (station: number) => void;
  leave: () => void;
}

const TourContext = createContext<Tour | null>(null);

/** The tour, across the operator's pages, theatre and supervisor. */
export function TourProvider({ children }: { children: ReactNode }): ReactNode {
  const { session } = useSession();
  const source = useLive().view.newest?.source.name ?? null;
  const isAllowed = session.state === "in" && mayTour(source, session.who.role);
  const [path, go] = useLocation();
  const [at, setAt] = useState<number | null>(null);
  const [wasLeft, setWasLeft] = useState(wasTourLeft);
  const show = useCallback(
    (station: number) => {
      const next = STATIONS[station];
      if (next === undefined) return;
      setAt(station);
      if (next.path !== path) go(next.path);
    },
    [path, go],
  );
  const leave = useCallback(() => {
    setAt(null);
    setWasLeft(true);
    storeTourLeft();
  }, []);
  const tour = useMemo(
    () => (isAllowed ? { at, wasLeft, show, leave } : null),
    [isAllowed, at, wasLeft, show, leave],
  );
  return (
    <TourContext value={tour}>
      {children}
      {tour !== null && at !== null && <TourCard at={at} tour={tour} />}
    </TourContext>
  );
}

/** The tour; null where it may not run. */
export function useTour(): Tour | null {
  return use(TourContext);
}
