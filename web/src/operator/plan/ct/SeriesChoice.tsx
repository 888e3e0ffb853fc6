import { Button } from "@mantine/core";
import type { ReactNode } from "react";
import { formatNumber } from "../../../live/rounding";
import type { Job } from "../../../rest/useJob";
import { useTexts } from "../../../texts/TextsContext";
import { pluralize } from "../../../texts/pluralize";

/** Properties of a series before it is read. */
interface Series {
  series: string;
  modality: string;
  words: string;
  number: number;
  patient: number;
  images: number;
  size_wh_px: [number, number];
  pixel_mm: [number, number];
  thickness_mm: number;
  kernel: string;
  problem: string;
}

/** Series that a job found in an upload; empty if it read the CT. */
export function seriesOf(job: Job): Series[] {
  const result = job.result as { series?: Series[] } | null;
  return Array.isArray(result?.series) ? result.series : [];
}

interface SeriesChoiceProps {
  series: readonly Series[];
  busy: boolean;
  onChoose: (series: string) => void;
}

/** Choice of one of several series. */
export function SeriesChoice({ series, busy, onChoose }: SeriesChoiceProps): ReactNode {
  const all = useTexts();
  const texts = all.plan.ct.series;
  if (series.length === 0) return null;
  const patients = new Set(series.map((one) => one.patient)).size;
  return (
    <section aria-label={texts.title}>
      <h3>{texts.title}</h3>
      <p>{texts.hint}</p>
      <ul className="series">
        {series.map((one) => (
          <li key={one.series} data-problem={one.problem !== "" || undefined}>
            <div>
              <strong>
                {one.number > 0 && `${one.number} · `}
                {one.words || texts.unnamed} {one.modality}
              </strong>
              <p>
                {pluralize(texts.images, one.images, all.language)} · {one.size_wh_px.join(" × ")} ·{" "}
                {formatNumber(one.thickness_mm, 2)} mm {texts.thick}
                {one.kernel !== "" && ` · ${one.kernel}`}
                {patients > 1 && ` · ${texts.patient} ${one.patient}`}
              </p>
              {one.problem !== "" && <p className="warning">{one.problem}</p>}
            </div>
            <Button
              size="lg"
              variant={one.problem === "" ? "filled" : "default"}
              disabled={busy}
              onClick={() => {
                onChoose(one.series);
              }}
            >
              {texts.choose}
            </Button>
          </li>
        ))}
      </ul>
    </section>
  );
}
