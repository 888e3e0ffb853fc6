import type { ReactNode } from "react";
import { shownNumber } from "../../../live/rounding";
import { useWords } from "../../../words/WordsContext";
import { WALLS, type Screw } from "../state/shape";

/** Bone left on each side, the grade that is to be expected, and how exactly it must be drilled. */
export function ScrewNumbers({ screw }: { screw: Screw }): ReactNode {
  const words = useWords().plan.screw;
  const { clearance, tolerance, bone } = screw;
  const breaks = clearance.breach_mm > 0;
  return (
    <div className="screw-numbers" data-testid="screw-numbers">
      <p className="grade" data-breaks={breaks || undefined}>
        <strong>
          {words.grade} {clearance.grade}
        </strong>{" "}
        {breaks ? `${words.breaks} ${shownNumber(clearance.breach_mm, 1)} mm` : words.within}
      </p>
      <dl className="figures">
        {WALLS.map((wall) => {
          const value = clearance[`${wall}_mm`];
          return (
            <div key={wall} className="figure" data-breaks={value < 0 || undefined}>
              <dt>{words.wall[wall]}</dt>
              <dd>
                {shownNumber(value, 1)} mm{value < 0 && ` ${words.through}`}
              </dd>
            </div>
          );
        })}
        <div className="figure">
          <dt>{words.tolerance}</dt>
          <dd>
            {shownNumber(tolerance.max_offset_mm, 1)} mm {words.or} {shownNumber(tolerance.max_angle_deg, 1)}°
            <span className="soft">
              {" "}
              {words.both} {shownNumber(tolerance.both_mm, 1)} mm + {shownNumber(tolerance.both_deg, 1)}°
            </span>
          </dd>
        </div>
        <div className="figure">
          <dt>{words.bone}</dt>
          <dd>
            {shownNumber(bone.mean_hu, 0)} HU
            {bone.inside_ratio < 0.999 && <span className="warning"> {words.beyondCt}</span>}
          </dd>
        </div>
      </dl>
    </div>
  );
}
