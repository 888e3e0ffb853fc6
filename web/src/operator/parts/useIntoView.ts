// Scrolls a new result into view and focuses its heading, since it is often below the fold.
import { useEffect, useRef, type RefObject } from "react";
import { prefersReducedMotion } from "../../marks/reducedMotion";
import { isInSight, throughAll, type Span } from "./inSight";

const HEADING = "h2, h3, h4";

/**
 * Returns the ref for the element of a result.
 *
 * @param fresh identifies a result that was just made here; a new value scrolls to it. Null if nothing is new, also
 *   if somebody else made what is shown.
 */
export function useIntoView<Shown extends HTMLElement>(fresh: string | null): RefObject<Shown | null> {
  const shown = useRef<Shown>(null);
  const last = useRef<string | null>(null);
  // On every render, because the element may be mounted later than the name changes.
  useEffect(() => {
    if (fresh === null || fresh === last.current || shown.current === null) return;
    last.current = fresh;
    bringIntoView(shown.current);
  });
  return shown;
}

/** Scrolls only if needed, and focuses the heading so that a screen reader announces it. */
export function bringIntoView(shown: HTMLElement): void {
  const heading = shown.querySelector<HTMLElement>(HEADING) ?? shown;
  heading.tabIndex = -1;
  heading.focus({ preventScroll: true });
  if (isInSight(shown.getBoundingClientRect(), throughAll(windowsOf(shown)))) return;
  shown.scrollIntoView({ behavior: prefersReducedMotion() ? "instant" : "smooth", block: "start" });
}

/** The visible area of the page below its fixed header, and of each scrolling ancestor. */
function windowsOf(shown: HTMLElement): Span[] {
  const under = parseFloat(getComputedStyle(document.documentElement).scrollPaddingTop) || 0;
  const windows: Span[] = [{ top: under, bottom: innerHeight }];
  for (let around = shown.parentElement; around !== null; around = around.parentElement) {
    if (/auto|scroll/.test(getComputedStyle(around).overflowY)) windows.push(around.getBoundingClientRect());
  }
  return windows;
}
