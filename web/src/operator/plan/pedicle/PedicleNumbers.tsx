import { Button } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { formatNumber } from "../../../live/rounding";
import { putPlanVertebraeByNamePediclesBySideCorrections } from "../../../api";
import { useTexts } from "../../../texts/TextsContext";
import { Remarks } from "../../parts/Remarks";
import { useSlices } from "../slices/SlicesContext";
import { usePlanning } from "../state/PlanContext";
import { NUMBERS, type NumberName, type Numbers, type PedicleRecord } from "../state/shape";
import { Stepper } from "../Stepper";

const STEP: Numbers = { width_mm: 0.5, height_mm: 0.5, transverse_deg: 1, sagittal_deg: 1, length_mm: 1 };
const unitOf = (name: NumberName): string => (name.endsWith("_deg") ? "°" : "mm");

/** Measured values with uncertainty and warnings, and corrections by hand. */
export function PedicleNumbers({ record, vertebra }: { record: PedicleRecord; vertebra: string }): ReactNode {
  const texts = useTexts().plan.pedicle;
  const { change, busy } = usePlanning();
  const { goTo } = useSlices();
  const { measured, corrected } = record;
  const [draft, setDraft] = useState<Partial<Numbers> | null>(null);
  const path = { name: vertebra, side: measured.side };
  const keep = (numbers: Partial<Numbers>): void => {
    void change((by) =>
      putPlanVertebraeByNamePediclesBySideCorrections({ path, body: { ...by, corrected: numbers } }),
    );
  };
  const now = draft ?? corrected;
  const isCorrected = Object.keys(corrected).length > 0;
  return (
    <section className="pedicle-numbers" aria-labelledby="pedicle-numbers">
      <h4 id="pedicle-numbers">{texts.numbers}</h4>
      {draft === null ? (
        <dl className="figures" data-testid="pedicle-numbers">
          {NUMBERS.map((name) => (
            <div key={name} className="figure">
              <dt>{texts.number[name]}</dt>
              <dd>
                {formatNumber(corrected[name] ?? measured[name], 1)} {unitOf(name)}
                <span className="soft">
                  {corrected[name] === undefined
                    ? ` ± ${formatNumber(measured.sd[name], 1)}`
                    : ` ${texts.byHand} (${formatNumber(measured[name], 1)})`}
                </span>
              </dd>
            </div>
          ))}
        </dl>
      ) : (
        NUMBERS.map((name) => (
          <Stepper
            key={name}
            name={name}
            label={texts.number[name]}
            value={`${formatNumber(now[name] ?? measured[name], 1)} ${unitOf(name)}`}
            onStep={(direction) => {
              const value = (now[name] ?? measured[name]) + direction * STEP[name];
              setDraft({ ...now, [name]: Math.round(value * 10) / 10 });
            }}
          />
        ))
      )}
      <Remarks remarks={measured.warnings} />
      <div className="buttons">
        <Button
          size="lg"
          variant="default"
          onClick={() => {
            goTo(measured.isthmus_lps_mm);
          }}
        >
          {texts.show}
        </Button>
        {draft === null ? (
          <Button
            size="lg"
            variant="default"
            data-testid="correct"
            onClick={() => {
              setDraft({ ...corrected });
            }}
          >
            {texts.correct}
          </Button>
        ) : (
          <>
            <Button
              size="lg"
              disabled={busy}
              data-testid="keep-corrections"
              onClick={() => {
                keep(draft);
              }}
            >
              {texts.keep}
            </Button>
            <Button
              size="lg"
              variant="default"
              onClick={() => {
                setDraft(null);
              }}
            >
              {texts.discard}
            </Button>
          </>
        )}
        {isCorrected && draft === null && (
          <Button
            size="lg"
            variant="default"
            disabled={busy}
            onClick={() => {
              keep({});
            }}
          >
            {texts.asMeasured}
          </Button>
        )}
      </div>
    </section>
  );
}
