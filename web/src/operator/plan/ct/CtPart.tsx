import { useState, type ReactNode } from "react";
import { Button } from "@mantine/core";
import { formatNumber } from "../../../live/rounding";
import { useTexts } from "../../../texts/TextsContext";
import { Maker } from "../../parts/Maker";
import { Remarks } from "../../parts/Remarks";
import { formatTime } from "../../parts/format";
import { LabelIntake } from "../labels/LabelIntake";
import { useSlices } from "../slices/SlicesContext";
import { CtIntake } from "./CtIntake";

/** The planned CT: properties, warnings, and replacement. */
export function CtPart({ onTaken }: { onTaken: () => void }): ReactNode {
  const all = useTexts();
  const texts = all.plan.ct;
  const { ct } = useSlices();
  const [isReplacing, setReplacing] = useState(false);
  const { description } = ct;
  const details = [description["words"], description["modality"], description["kernel"]].filter(
    (one): one is string => typeof one === "string" && one !== "",
  );
  return (
    <>
      <h3>{texts.title}</h3>
      <p>{details.join(" · ")}</p>
      <dl className="figures">
        <dt>{texts.voxels}</dt>
        <dd>{ct.size_ijk.join(" × ")}</dd>
        <dt>{texts.spacing}</dt>
        <dd>{ct.spacing_mm.map((one) => formatNumber(one, 2)).join(" × ")} mm</dd>
        <dt>{texts.madeBy}</dt>
        <dd>
          <Maker of={ct.heading} />, {formatTime(ct.heading.made_at, all.language)}
        </dd>
      </dl>
      <Remarks remarks={ct.warnings} />
      {isReplacing ? (
        <CtIntake isSecond onTaken={onTaken} />
      ) : (
        <Button
          size="lg"
          variant="default"
          data-testid="other-ct"
          onClick={() => {
            setReplacing(true);
          }}
        >
          {texts.other}
        </Button>
      )}
      <LabelIntake />
    </>
  );
}
