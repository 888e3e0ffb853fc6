import { useSyncExternalStore } from "react";

/** A theatre screen: wide enough for three cuts beside the video, and for layouts. */
const WIDE = "(min-width: 1400px) and (min-aspect-ratio: 11/10)";
/** A laptop, which is read from near. */
export const WIDE_BOARD = "(min-width: 1200px) and (min-aspect-ratio: 11/10)";

export function useIsWide(wide: string = WIDE): boolean {
  return useSyncExternalStore(
    (onChange) => {
      const query = matchMedia(wide);
      query.addEventListener("change", onChange);
      return () => {
        query.removeEventListener("change", onChange);
      };
    },
    () => matchMedia(wide).matches,
  );
}
