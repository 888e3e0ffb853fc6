// What a touch has made is often below the fold: it is brought into view, and its name read out.
import { useEffect, useRef, type RefObject } from "react";
import { prefersReducedMotion } from "../../marks/reducedMotion";
import { isInSight, throughAll, type Span } from "./inSight";

const HEADING = "h2, h3, h4";

/**
 * For the element that shows a result.
 *
 * @param fresh names what was just made here; whenever it becomes another name, that is brought into view.
 *   Null while there is nothing new, also when somebody else made what is shown.
 */
export function useIntoView<Shown extends HTMLElement>(fresh: string | null): RefObject<Shown | null> {
  const shown = useRef<Shown>(null);
  const last = useRef<string | null>(null);
  // With every render, because the element may come later than the name.
  useEffect(() => {
    if (fresh === null || fresh === last.current || shown.current === null) return;
    last.current = fresh;
    bringIntoView(shown.current);
  });
  return shown;
}

/** Moves the page only where it must, and the focus to the heading, so that a screen reader says it. */
export function bringIntoView(shown: HTMLElement): void {
  const heading = shown.querySelector<HTMLElement>(HEADING) ?? shown;
  heading.tabIndex = -1;
  heading.focus({ preventScroll: true });
  if (isInSight(shown.getBoundingClientRect(), throughAll(windowsOf(shown)))) return;
  shown.scrollIntoView({ behavior: prefersReducedMotion() ? "instant" : "smooth", block: "start" });
}

/** The page below what stays at its top, and every panel around it that scrolls by itself. */
function windowsOf(shown: HTMLElement): Span[] {
  const under = parseFloat(getComputedStyle(document.documentElement).scrollPaddingTop) || 0;
  const windows: Span[] = [{ top: under, bottom: innerHeight }];
  for (let around = shown.parentElement; around !== null; around = around.parentElement) {
    if (/auto|scroll/.test(getComputedStyle(around).overflowY)) windows.push(around.getBoundingClientRect());
  }
  return windows;
}
