import { Button } from "@mantine/core";
import { useEffect, useEffectEvent, useRef, type ReactNode } from "react";
import { useLocation } from "wouter";
import { interpolate } from "../texts/interpolate";
import { useTexts } from "../texts/TextsContext";
import { STATIONS } from "./stations";
import type { Tour } from "./TourContext";
import { useShownPart } from "./useShownPart";

/** What closes by Escape before the tour does. */
const CLOSED_FIRST = '[role="dialog"], details[open], [aria-expanded="true"]';

/** One station of the tour, beside its page, which stays usable. */
export function TourCard({ at, tour }: { at: number; tour: Tour }): ReactNode {
  const texts = useTexts().tour;
  const [path] = useLocation();
  const onward = useRef<HTMLButtonElement>(null);
  const station = STATIONS[at];
  const { card, ring } = useShownPart(station);
  useEffect(() => {
    // Also after the page of a station has taken the focus on arrival.
    if (path === station?.path) onward.current?.focus({ preventScroll: true });
  }, [path, station]);
  const onKey = useEffectEvent(({ key, target }: KeyboardEvent) => {
    if (key !== "Escape" || (target instanceof Element && target.closest(CLOSED_FIRST) !== null)) return;
    tour.leave();
  });
  useEffect(() => {
    const stop = new AbortController();
    // Before the page reacts, while what it closes is still open.
    addEventListener("keydown", onKey, { capture: true, signal: stop.signal });
    return () => {
      stop.abort();
    };
  }, []);
  if (station === undefined) return null;
  const { title, sentence } = texts.stations[station.name];
  const isLast = at === STATIONS.length - 1;
  return (
    <>
      <div className="tour-ring" ref={ring} hidden aria-hidden="true" />
      <aside
        className="tour"
        ref={card}
        aria-label={texts.title}
        data-testid="tour"
        data-station={station.name}
      >
        <p className="soft">
          {texts.title} · {interpolate(texts.count, { at: at + 1, all: STATIONS.length })} · {texts.escape}
        </p>
        <div className="tour-said" aria-live="polite">
          <h2>{title}</h2>
          <p>{sentence}</p>
        </div>
        <div className="row">
          {!isLast && (
            <Button size="lg" variant="subtle" onClick={tour.leave} data-testid="tour-leave">
              {texts.leave}
            </Button>
          )}
          <Button
            size="lg"
            variant="default"
            disabled={at === 0}
            onClick={() => {
              tour.show(at - 1);
            }}
            data-testid="tour-back"
          >
            {texts.back}
          </Button>
          <Button
            size="lg"
            ref={onward}
            onClick={() => {
              if (isLast) tour.leave();
              else tour.show(at + 1);
            }}
            data-testid="tour-next"
          >
            {isLast ? texts.end : texts.next}
          </Button>
        </div>
      </aside>
    </>
  );
}
