import { Alert } from "@mantine/core";
import type { ReactNode } from "react";
import { formatCount, formatNumber } from "../../../live/rounding";
import type { DocumentMessage } from "../../../api";
import { useTexts } from "../../../texts/TextsContext";
import { Remarks, type Remark } from "../../parts/Remarks";
import { vec3 } from "../slices/vectors";

type Surface = DocumentMessage;

/** Source, size and warnings of the surface. */
export function SurfaceNumbers({ surface }: { surface: Surface }): ReactNode {
  const texts = useTexts().plan.surface;
  const { content, heading } = surface;
  const [low, high] = [vec3(content["low_lps_mm"]), vec3(content["high_lps_mm"])];
  const remarks = Array.isArray(content["remarks"]) ? (content["remarks"] as Remark[]) : [];
  return (
    <div data-testid="surface-numbers">
      {heading.out_of_date !== null && (
        <Alert className="consequence" title={texts.outOfDate}>
          {heading.out_of_date}
        </Alert>
      )}
      <dl className="figures">
        <div className="figure">
          <dt>{texts.source}</dt>
          <dd>{content["source"] === "ct" ? texts.fromCt : texts.fromFile}</dd>
        </div>
        <div className="figure">
          <dt>{texts.faces}</dt>
          <dd>{formatCount(Number(content["faces"]))}</dd>
        </div>
        {low !== null && high !== null && (
          <div className="figure">
            <dt>{texts.size}</dt>
            <dd>{high.map((one, i) => formatNumber(one - (low[i] ?? 0), 0)).join(" × ")} mm</dd>
          </div>
        )}
        {typeof content["threshold_hu"] === "number" && (
          <div className="figure">
            <dt>{texts.threshold}</dt>
            <dd>{formatNumber(content["threshold_hu"], 0)} HU</dd>
          </div>
        )}
      </dl>
      <Remarks remarks={remarks} />
    </div>
  );
}
