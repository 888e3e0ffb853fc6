import type { ReactNode } from "react";
import { formatNumber } from "../../../live/rounding";
import { useTexts } from "../../../texts/TextsContext";
import { isFlat, type PlaneName } from "./address";
import type { Projection } from "./projection";
import { rulerMm } from "./zoom";

interface SliceLabelsProps {
  plane: PlaneName;
  projection: Projection;
  /** Key under which the displayed picture was requested. */
  address: string;
  isLate: boolean;
  isLarge: boolean;
}

/** Orientation labels, ruler and position of the displayed slice. */
export function SliceLabels({ plane, projection, address, isLate, isLarge }: SliceLabelsProps): ReactNode {
  const texts = useTexts().plan.slices;
  const { edges, at_mm } = projection.place;
  const query = new URL(address, location.origin).searchParams;
  const ruler = rulerMm(projection.pxPerMm, isLarge ? 140 : 70);
  const where = isFlat(plane)
    ? `${texts.axis[plane]} ${formatNumber(at_mm, 1)} mm`
    : plane === "along"
      ? `${texts.turned} ${query.get("rotation_deg") ?? ""}°`
      : `${texts.deep} ${formatNumber(Number(query.get("depth_mm")), 1)} mm`;
  return (
    <>
      <span className="slice-edge slice-edge-left">{edges.left}</span>
      <span className="slice-edge slice-edge-right">{edges.right}</span>
      <span className="slice-edge slice-edge-top">{edges.top}</span>
      <span className="slice-edge slice-edge-bottom">{edges.bottom}</span>
      <p className="slice-where" data-testid={`where-${plane}`}>
        <strong>{texts.plane[plane]}</strong> {where}
        {isLate && <span className="slice-late"> · {texts.late}</span>}
      </p>
      <p className="slice-ruler">
        <span style={{ width: `${ruler * projection.pxPerMm}px` }} />
        {ruler} mm
      </p>
    </>
  );
}
