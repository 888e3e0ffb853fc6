import type { ReactNode } from "react";
import { getCtSlicesByPlane } from "../../../api";
import { useQuery } from "../../../rest/useQuery";
import { useTexts } from "../../../texts/TextsContext";
import { pxInSlice } from "./sliceView";

const PLANES = { axial: 2, sagittal: 0 } as const;
const PIXEL_MM = 0.4;
/** Displayed size around the landmark. */
const SHOWN_MM = 90;

interface LandmarkSliceProps {
  plane: keyof typeof PLANES;
  pointMm: readonly number[];
}

/** CT slice through a landmark, marked by a ring. */
export function LandmarkSlice({ plane, pointMm }: LandmarkSliceProps): ReactNode {
  const texts = useTexts().registration.points;
  const atMm = pointMm[PLANES[plane]] ?? 0;
  const { data } = useQuery(
    (signal) => getCtSlicesByPlane({ signal, path: { plane }, query: { at_mm: atMm, pixel_mm: PIXEL_MM } }),
    { key: `${plane} ${atMm}` },
  );
  if (data === null) return <div className="landmark-slice" />;
  const [u, v] = pxInSlice(data.lps_from_px, pointMm);
  const shownPx = SHOWN_MM / PIXEL_MM;
  // As shares of the frame, whose size in mm is fixed.
  const style = {
    width: `${(100 * data.width_px) / shownPx}%`,
    left: `${50 - (100 * (u + 0.5)) / shownPx}%`,
    top: `${50 - (100 * (v + 0.5)) / shownPx}%`,
  };
  return (
    <figure className="landmark-slice">
      <img
        src={`/api/ct/slices/${plane}.png?at_mm=${atMm}&pixel_mm=${PIXEL_MM}`}
        alt={texts.sliceAlt[plane]}
        style={style}
      />
      <svg viewBox="-50 -50 100 100" aria-hidden="true">
        <circle r="7" />
        <path d="M-18 0H-9M9 0H18M0 -18V-9M0 9V18" />
      </svg>
      <span className="edge edge-left">{data.edges.left}</span>
      <span className="edge edge-right">{data.edges.right}</span>
      <span className="edge edge-top">{data.edges.top}</span>
      <span className="edge edge-bottom">{data.edges.bottom}</span>
      <figcaption>{texts.slice[plane]}</figcaption>
    </figure>
  );
}
