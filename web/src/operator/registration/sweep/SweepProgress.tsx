import type { ReactNode } from "react";
import { formatNumber } from "../../../live/rounding";
import type { SweepMessage } from "../../../api";
import { useTexts } from "../../../texts/TextsContext";

/** Number of measured points and their extent. */
export function SweepProgress({ sweep }: { sweep: SweepMessage }): ReactNode {
  const texts = useTexts().registration.sweep;
  const reach = sweep.reach_mm.map((mm) => formatNumber(mm, 0)).join(" × ");
  return (
    <dl className="limits" data-testid="sweep-progress" data-points={sweep.points}>
      <div className="limit">
        <dt>{sweep.taking ? `● ${texts.taking}` : `■ ${texts.lifted}`}</dt>
        <dd>
          <strong>
            {sweep.points} <span className="unit">{texts.points}</span>
          </strong>
        </dd>
      </div>
      <div className="limit">
        <dt>
          {texts.reach}
          <small>{texts.reachHint}</small>
        </dt>
        <dd>
          <strong>
            {reach} <span className="unit">mm</span>
          </strong>
        </dd>
      </div>
      <div className="limit">
        <dt>{texts.unseen}</dt>
        <dd>
          <strong>{sweep.unseen}</strong>
        </dd>
      </div>
    </dl>
  );
}
