import type { ReactNode } from "react";
import { Rejection } from "../../../rest/client";
import { interpolate } from "../../../texts/interpolate";
import { useTexts } from "../../../texts/TextsContext";
import { Remarks } from "../../parts/Remarks";
import { Measure } from "../Measure";
import { RegistrationRejection } from "../RegistrationRejection";
import { useSides } from "../useSides";
import type { Points } from "./PointsWork";

/** Fit of the landmarks, resulting error at the entry points, and what is missing. */
export function FitPanel({ points }: { points: Points }): ReactNode {
  const texts = useTexts().registration;
  const sideName = useSides();
  const { limits, targets } = points;
  const strays = points.landmarks.map((one) => one.leave_one_out_mm).filter((mm) => mm !== null);
  const sides = [...new Set(targets.map((one) => one.side))];
  return (
    <section className="card" aria-live="polite">
      <dl className="limits">
        <Measure
          name={texts.numbers.fre}
          hint={texts.numbers.freHint}
          value={points.fre_rms_mm}
          unit="mm"
          max={limits.max_fre_mm}
        />
        {sides.map((side) => (
          <Measure
            key={side}
            name={`${texts.numbers.atEntry} ${sideName(side)}`}
            hint={texts.numbers.atEntryHint}
            value={targets.find((one) => one.side === side && one.depth_mm === 0)?.stated_mm ?? null}
            unit="mm"
            max={limits.max_tre_mm}
          />
        ))}
        {strays.length > 0 && (
          <Measure
            name={texts.numbers.leftOut}
            hint={texts.numbers.leftOutHint}
            value={Math.max(...strays)}
            unit="mm"
            max={limits.max_left_out_mm}
          />
        )}
      </dl>
      <Remarks remarks={points.remarks} />
      <div data-testid="points-missing">
        {points.landmarks.some((one) => one.touched) ? (
          points.missing.map((problem) => (
            <RegistrationRejection key={problem.code} rejection={new Rejection(problem)} />
          ))
        ) : (
          // Nothing has been done yet, so nothing is wrong.
          <p className="quiet">{interpolate(texts.points.needed, { min: limits.min_points })}</p>
        )}
      </div>
      {points.missing.length === 0 && (
        <p className="good" data-testid="points-pass">
          ✓ {texts.points.passes}
        </p>
      )}
    </section>
  );
}
