import { useState, useSyncExternalStore, type ReactNode } from "react";
import { CutTile, OnlyTile } from "../cuts/CutTile";
import { FIRST_CHOICE, pairOf } from "../cuts/tileChoice";

/** Room for three cuts beside the video. */
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
 * The cuts through the CT and the 3-D scene: on a theatre's screen axial, sagittal and the probe's eye, where another cut takes
 * the place of the sagittal one, and the scene that of both, by a touch; one of all on a smaller screen.
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
