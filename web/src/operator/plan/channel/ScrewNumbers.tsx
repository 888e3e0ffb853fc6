import type { ReactNode } from "react";
import { formatNumber } from "../../../live/rounding";
import { useTexts } from "../../../texts/TextsContext";
import { WALLS, type Screw } from "../state/shape";

/** Bone left on each side, expected grade, and required accuracy. */
export function ScrewNumbers({ screw }: { screw: Screw }): ReactNode {
  const texts = useTexts().plan.screw;
  const { clearance, tolerance, bone } = screw;
  const breaks = clearance.breach_mm > 0;
  return (
    <div className="screw-numbers" data-testid="screw-numbers">
      <p className="grade" data-breaks={breaks || undefined}>
        <strong>
          {texts.grade} {clearance.grade}
        </strong>{" "}
        {breaks ? `${texts.breaks} ${formatNumber(clearance.breach_mm, 1)} mm` : texts.within}
      </p>
      <dl className="figures">
        {WALLS.map((wall) => {
          const value = clearance[`${wall}_mm`];
          return (
            <div key={wall} className="figure" data-breaks={value < 0 || undefined}>
              <dt>{texts.wall[wall]}</dt>
              <dd>
                {formatNumber(value, 1)} mm{value < 0 && ` ${texts.through}`}
              </dd>
            </div>
          );
        })}
        <div className="figure">
          <dt>{texts.tolerance}</dt>
          <dd>
            {formatNumber(tolerance.max_offset_mm, 1)} mm {texts.or}{" "}
            {formatNumber(tolerance.max_angle_deg, 1)}°
            <span className="soft">
              {" "}
              {texts.both} {formatNumber(tolerance.both_mm, 1)} mm + {formatNumber(tolerance.both_deg, 1)}°
            </span>
          </dd>
        </div>
        <div className="figure">
          <dt>{texts.bone}</dt>
          <dd>
            {formatNumber(bone.mean_hu, 0)} HU
            {bone.inside_ratio < 0.999 && <span className="warning"> {texts.beyondCt}</span>}
          </dd>
        </div>
      </dl>
    </div>
  );
}
