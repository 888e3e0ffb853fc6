import type { ReactNode } from "react";
import { formatFigure, formatNumber, formatPercent } from "../../../live/rounding";
import { useTexts } from "../../../texts/TextsContext";
import { interpolate } from "../../../texts/interpolate";
import type { Proposal } from "./ProposalPanel";
import { useNeedleNames } from "./useNeedleNames";

interface ProposalCardProps {
  number: number;
  proposal: Proposal;
  isPicked: boolean;
  onPick: () => void;
}

/** One assignment of names to detected needles, with their distances from the plan in the image and in mm. */
export function ProposalCard({ number, proposal, isPicked, onPick }: ProposalCardProps): ReactNode {
  const texts = useTexts().registration.proposal;
  const nameOf = useNeedleNames();
  const { laid, probability_ratio } = proposal;
  const depth = laid.directions[0];
  return (
    <li>
      <button
        type="button"
        className="proposal"
        aria-pressed={isPicked}
        onClick={onPick}
        data-testid={`proposal-${number}`}
      >
        <strong>{interpolate(texts.number, { number })}</strong>{" "}
        <span>{interpolate(texts.probability, { percent: formatPercent(probability_ratio) })}</span>
        <table>
          <thead>
            <tr>
              <th>{texts.needle}</th>
              <th>px</th>
              <th>mm</th>
              <th>{texts.lean}</th>
            </tr>
          </thead>
          <tbody>
            {laid.needles.map((needle) => (
              <tr key={needle.name}>
                <th scope="row">{nameOf(needle.name)}</th>
                <td>{formatFigure(needle.offset_px, 1)}</td>
                <td>{formatFigure(needle.offset_mm, 1)}</td>
                <td>{formatFigure(needle.lean_deg, 0)}°</td>
              </tr>
            ))}
          </tbody>
        </table>
        {depth !== undefined && (
          <small>{interpolate(texts.depth, { sd: formatNumber(depth.sd, 1), unit: depth.unit })}</small>
        )}
      </button>
    </li>
  );
}
