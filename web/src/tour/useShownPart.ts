// Marks the part of the page that a station shows: scrolls it into view, and puts a ring around it. Moves the card of
// the tour away from the alarms.
import { useEffect, useRef, type RefObject } from "react";
import { prefersReducedMotion } from "../marks/reducedMotion";
import { placeBeside } from "./place";
import type { Station } from "./stations";

/** Elements with it keep clear of the card when they are scrolled into view. */
const ATTRIBUTE = "data-toured";
const LOOK_EVERY_MS = 200;
/** The page may be loaded and laid out meanwhile; later the user scrolls. */
const SCROLLS_FIRST = 6;

interface ShownPart {
  card: RefObject<HTMLElement | null>;
  ring: RefObject<HTMLDivElement | null>;
}

/** Returns the refs for the card and for the ring, elements with a fixed position. */
export function useShownPart(station: Station | undefined): ShownPart {
  const card = useRef<HTMLElement>(null);
  const ring = useRef<HTMLDivElement>(null);
  useEffect(() => {
    if (station === undefined) return;
    let shown: Element | null = null;
    let looks = 0;
    const follow = (): void => {
      if (ring.current !== null) surround(ring.current, shown);
      if (card.current !== null) keepClear(card.current);
    };
    // A page may be loaded later than the station, and mount the part again.
    const look = (): void => {
      const found = document.querySelector(station.part);
      if (found !== shown) {
        shown?.removeAttribute(ATTRIBUTE);
        found?.setAttribute(ATTRIBUTE, "");
        shown = found;
      }
      looks += 1;
      if (looks <= SCROLLS_FIRST)
        found?.scrollIntoView({ behavior: prefersReducedMotion() ? "instant" : "smooth", block: "nearest" });
      follow();
    };
    look();
    const stop = new AbortController();
    const timer = setInterval(look, LOOK_EVERY_MS);
    addEventListener("scroll", follow, { capture: true, passive: true, signal: stop.signal });
    return () => {
      stop.abort();
      clearInterval(timer);
      shown?.removeAttribute(ATTRIBUTE);
    };
  }, [station]);
  return { card, ring };
}

function surround(ring: HTMLElement, shown: Element | null): void {
  const box = shown?.getBoundingClientRect();
  ring.hidden = box === undefined;
  if (box === undefined) return;
  ring.style.translate = `${String(box.left)}px ${String(box.top)}px`;
  ring.style.width = `${String(box.width)}px`;
  ring.style.height = `${String(box.height)}px`;
}

function keepClear(card: HTMLElement): void {
  const alarms = document.querySelector(".alarms")?.getBoundingClientRect();
  if (alarms === undefined) return;
  // Its height without being folded, which is measured in one layout.
  card.dataset["place"] = "bottom";
  const { height, bottom } = card.getBoundingClientRect();
  const marginPx = innerHeight - bottom;
  card.dataset["place"] = placeBeside({ heightPx: innerHeight, alarms, cardPx: height, marginPx });
}
