// The alarm band stays in sight while the page moves under it: everything else that stays must know how high it is.
import { useEffect, useRef, type RefObject } from "react";

/** Keeps the height of what has this ref as `--band-height` of the whole page, however its lines are broken. */
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
