// Publishes the height of the fixed alarm band for other fixed and scrolled elements.
import { useEffect, useRef, type RefObject } from "react";

/** Keeps the height of the referenced element in `--band-height`. */
export function useBandHeight<Band extends HTMLElement>(): RefObject<Band | null> {
  const band = useRef<Band>(null);
  useEffect(() => {
    const element = band.current;
    if (element === null) return;
    const page = document.documentElement;
    const watch = new ResizeObserver(() => {
      page.style.setProperty(
        "--band-height",
        `${String(Math.ceil(element.getBoundingClientRect().height))}px`,
      );
    });
    watch.observe(element);
    return () => {
      watch.disconnect();
      page.style.removeProperty("--band-height");
    };
  }, []);
  return band;
}
