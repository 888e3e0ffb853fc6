import { useState, useSyncExternalStore, type ReactNode } from "react";
import { CutTile, OnlyTile } from "../cuts/CutTile";
import { FIRST_CHOICE, pairOf } from "../cuts/tileChoice";

/** Wide enough for three cuts beside the video. */
const WIDE = "(min-width: 1400px) and (min-aspect-ratio: 11/10)";

function useIsWide(): boolean {
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

/**
 * The cuts of the CT and the 3-D scene. A theatre screen shows axial, sagittal and the probe's eye; a touch replaces
 * the sagittal by another cut, or both by the scene. A smaller screen shows one of them.
 */
export function Tiles(): ReactNode {
  const isWide = useIsWide();
  const [choice, setChoice] = useState(FIRST_CHOICE);
  if (!isWide) return <OnlyTile choice={choice} onChoose={setChoice} />;
  const { upper, lower, choices } = pairOf(choice);
  return (
    <>
      <div className="tiles">
        {lower !== "scene" && <CutTile name={upper} choice={choice} onChoose={setChoice} hasKind />}
        <CutTile name={lower} choices={choices} choice={choice} onChoose={setChoice} />
      </div>
      <div className="tiles tiles-eye">
        <CutTile name="probe" choice={choice} onChoose={setChoice} />
      </div>
    </>
  );
}
