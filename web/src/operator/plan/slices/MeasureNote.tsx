import type { ReactNode } from "react";
import { formatNumber } from "../../../live/rounding";
import { Icon } from "../../../panes/Icon";
import { useTexts } from "../../../texts/TextsContext";
import { angleDeg, lengthsMm } from "./measure";
import { useSlices } from "./SlicesContext";

/** Figures of the measurement, which a touch removes; before its first point, what to do. */
export function MeasureNote(): ReactNode {
  const texts = useTexts().plan.slices.measure;
  const { hand, measurement, setMeasurement } = useSlices();
  if (measurement.length === 0) {
    return hand === "measure" ? <p className="measure-note">{texts.hint}</p> : null;
  }
  const angle = angleDeg(measurement);
  const figures = lengthsMm(measurement).map((mm) => `${formatNumber(mm, 1)} mm`);
  if (angle !== null) figures.push(`${formatNumber(angle, 1)}°`);
  const text = figures.length === 0 ? texts.next : figures.join(" · ");
  return (
    <button
      type="button"
      className="measure-note"
      aria-label={`${texts.remove}: ${text}`}
      data-testid="remove-measurement"
      onClick={() => {
        setMeasurement([]);
      }}
    >
      <output data-testid="measurement">{text}</output>
      <Icon name="cross" />
    </button>
  );
}
