import type { ReactNode } from "react";
import { useTexts } from "../../../texts/TextsContext";
import { LandmarkSlice } from "./LandmarkSlice";

interface WhereToTouchProps {
  name: string;
  pointMm: readonly number[];
}

/** Position of the landmark in two CT slices. */
export function WhereToTouch({ name, pointMm }: WhereToTouchProps): ReactNode {
  const texts = useTexts().registration.points;
  return (
    <section className="where" aria-label={`${texts.where}: ${name}`} data-testid="where">
      <LandmarkSlice plane="axial" pointMm={pointMm} />
      <LandmarkSlice plane="sagittal" pointMm={pointMm} />
    </section>
  );
}
