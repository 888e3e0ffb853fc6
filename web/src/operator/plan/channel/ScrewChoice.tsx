import { Button } from "@mantine/core";
import type { ReactNode } from "react";
import {
  deletePlanVertebraeByNameChannelsBySideScrew,
  getPlanCatalogue,
  putPlanVertebraeByNameChannelsBySideScrew,
} from "../../../api";
import { formatExact } from "../../../live/rounding";
import { useQuery } from "../../../rest/useQuery";
import { useTexts } from "../../../texts/TextsContext";
import { usePlanning } from "../state/PlanContext";
import type { PlannedChannel } from "../state/shape";
import { Stepper } from "../Stepper";
import { neighbourOf, rangesWith } from "./catalogue";
import { ClearanceNote } from "./ClearanceNote";
import { ScrewNumbers } from "./ScrewNumbers";

interface ScrewChoiceProps {
  vertebra: string;
  planned: PlannedChannel;
  isMeasured: boolean;
}

/** Choice of a catalogue screw: the proposed one, or another size. */
export function ScrewChoice({ vertebra, planned, isMeasured }: ScrewChoiceProps): ReactNode {
  const texts = useTexts().plan.screw;
  const { change, busy } = usePlanning();
  const catalogue = useQuery((signal) => getPlanCatalogue({ signal })).data;
  const diameters = catalogue?.diameters_mm ?? [];
  const lengths = catalogue?.lengths_mm ?? [];
  const ranges = catalogue?.ranges ?? [];
  const path = { name: vertebra, side: planned.side };
  const screw = planned.screws[0] ?? null;
  const choose = (size: { diameter_mm: number; length_mm: number } | null): void => {
    void change((by) =>
      putPlanVertebraeByNameChannelsBySideScrew({ path, body: { ...by, ...(size ?? {}) } }),
    );
  };
  const remove = (): void => {
    void change((by) => deletePlanVertebraeByNameChannelsBySideScrew({ path, query: by }));
  };
  if (!isMeasured) return <p className="soft">{texts.notMeasured}</p>;
  return (
    <section className="screw" aria-label={texts.title}>
      <h3>{texts.title}</h3>
      {screw === null ? (
        <Button
          size="xl"
          fullWidth
          disabled={busy}
          data-testid="propose-screw"
          onClick={() => {
            choose(null);
          }}
        >
          {texts.propose}
        </Button>
      ) : (
        <>
          <Stepper
            name="diameter"
            label={texts.diameter}
            value={`${formatExact(screw.diameter_mm)} mm`}
            disabled={busy || catalogue === null}
            hasLess={neighbourOf(diameters, screw.diameter_mm, -1) !== null}
            hasMore={neighbourOf(diameters, screw.diameter_mm, 1) !== null}
            onStep={(direction) => {
              const diameter_mm = neighbourOf(diameters, screw.diameter_mm, direction);
              if (diameter_mm !== null) choose({ diameter_mm, length_mm: screw.length_mm });
            }}
          />
          <Stepper
            name="length"
            label={texts.length}
            value={`${formatExact(screw.length_mm)} mm`}
            disabled={busy || catalogue === null}
            hasLess={neighbourOf(lengths, screw.length_mm, -1) !== null}
            hasMore={neighbourOf(lengths, screw.length_mm, 1) !== null}
            onStep={(direction) => {
              const length_mm = neighbourOf(lengths, screw.length_mm, direction);
              if (length_mm !== null) choose({ diameter_mm: screw.diameter_mm, length_mm });
            }}
          />
          {ranges.length > 0 && (
            <p className="soft" data-testid="screw-ranges">
              {texts.range}: {rangesWith(ranges, screw).join(", ") || texts.noRange}
            </p>
          )}
          <ScrewNumbers screw={screw} />
          <ClearanceNote vertebra={vertebra} side={planned.side} />
          <div className="buttons">
            <Button
              size="lg"
              variant="default"
              disabled={busy}
              onClick={() => {
                choose(null);
              }}
            >
              {texts.propose}
            </Button>
            <Button size="lg" variant="default" disabled={busy} onClick={remove}>
              {texts.remove}
            </Button>
          </div>
        </>
      )}
    </section>
  );
}
