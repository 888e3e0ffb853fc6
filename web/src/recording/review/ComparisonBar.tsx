import { Button } from "@mantine/core";
import type { ReactNode } from "react";
import { formatFigure, formatNumber } from "../../live/rounding";
import { FIGURES } from "../../panes/limits";
import { interpolate } from "../../texts/interpolate";
import { useTexts } from "../../texts/TextsContext";
import { comparisonOf, type ComparedValue } from "./comparison";
import type { LinkedInstants } from "./useLinkedInstants";

interface ComparisonBarProps {
  linked: LinkedInstants;
  titles: readonly [string, string];
  onClose: () => void;
}

/** The link of two recordings, and the figures of both with their difference. */
export function ComparisonBar({ linked, titles, onClose }: ComparisonBarProps): ReactNode {
  const texts = useTexts();
  const own = texts.recording.review.pair;
  const { sides, offsetS, setOffsetS } = linked;
  const [first, second] = [sides[0].shown.instant, sides[1].shown.instant];
  const isKnown = first !== null && second !== null;
  const compared = isKnown && offsetS !== null ? comparisonOf(first, second, offsetS) : null;
  const reason =
    offsetS === null ? own.unlinked : compared?.reason == null ? "" : own.reasons[compared.reason];
  return (
    <div className="review-comparison">
      <div className="row">
        <Button
          size="lg"
          data-testid="review-align"
          disabled={!isKnown}
          onClick={() => {
            if (isKnown) setOffsetS(second.at_s - first.at_s);
          }}
        >
          {own.align}
        </Button>
        <Button
          size="lg"
          variant="default"
          data-testid="review-unlink"
          disabled={offsetS === null}
          onClick={() => {
            setOffsetS(null);
          }}
        >
          {own.unlink}
        </Button>
        <Button size="lg" variant="default" data-testid="review-pair-close" onClick={onClose}>
          {own.close}
        </Button>
        <p data-testid="review-offset">
          {offsetS === null ? own.notLinked : interpolate(own.offset, { offset: signedText(offsetS) })}
        </p>
      </div>
      <p className="soft">{offsetS === null ? own.howToAlign : own.howToUnlink}</p>
      <table className="review-difference" data-testid="review-difference">
        <thead>
          <tr>
            <th scope="col">{own.figure}</th>
            <th scope="col">{titles[0]}</th>
            <th scope="col">{titles[1]}</th>
            <th scope="col">{own.difference}</th>
          </tr>
        </thead>
        <tbody>
          {FIGURES.map((name) => {
            const figure = compared?.figures[name];
            const { name: title, unit } = texts.reading[name];
            return (
              <tr key={name}>
                <th scope="row">
                  {title} <span className="unit">{unit}</span>
                </th>
                <td>{valueText(figure?.first)}</td>
                <td>{valueText(figure?.second)}</td>
                <td data-testid={`review-difference-${name}`}>{valueText(figure?.difference)}</td>
              </tr>
            );
          })}
        </tbody>
      </table>
      <p className="soft" role="status" data-testid="review-difference-reason">
        {reason}
      </p>
    </div>
  );
}

/** "+ 0.30", "− 0.30". */
const signedText = (offsetS: number): string =>
  `${offsetS < 0 ? "\u2212" : "+"} ${formatNumber(Math.abs(offsetS), 2)}`;

/** "0.3 ± 0.42", or "—"; an error is rounded up. */
function valueText(compared: ComparedValue | null | undefined): string {
  if (compared == null) return "—";
  const { value, error95 } = compared;
  if (error95 === null) return formatFigure(value);
  return `${formatFigure(value)} ± ${formatNumber(Math.ceil(100 * error95 - 1e-6) / 100, 2)}`;
}
