import { useSyncExternalStore } from "react";

/** A theatre screen: wide enough for three cuts beside the video, and for layouts. */
const WIDE = "(min-width: 1400px) and (min-aspect-ratio: 11/10)";

export function useIsWide(): boolean {
  return useSyncExternalStore(
    (onChange) => {
      const query = matchMedia(WIDE);
      query.addEventListener("change", onChange);
      return () => {
        query.removeEventListener("change", onChange);
      };
    },
    () => matchMedia(WIDE).matches,
  );
}
