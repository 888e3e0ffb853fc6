import { Button, NumberInput, SegmentedControl } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { postCertificatesCollection } from "../../api";
import { RejectionNote } from "../../rest/RejectionNote";
import { useAction } from "../../rest/useAction";
import { interpolate } from "../../texts/interpolate";
import { useTexts } from "../../texts/TextsContext";
import { FileButton } from "../parts/FileButton";

/** Of a length that is read from a steel ruler; calipers are better. */
const RULER_SD_MM = 0.2;

interface AccuracyBeginProps {
  tools: readonly string[];
  onBegun: () => void;
}

/** Tool, plate and measured rulers of an accuracy test. */
export function AccuracyBegin({ tools, onBegun }: AccuracyBeginProps): ReactNode {
  const texts = useTexts().certificate.guided;
  const beginning = useAction();
  const [tool, setTool] = useState<string | null>(null);
  const [plate, setPlate] = useState<File | null>(null);
  const [rulersMm, setRulersMm] = useState<readonly [number | string, number | string]>(["", ""]);
  const chosen = tools.find((one) => one === tool) ?? tools[0];
  if (chosen === undefined) return <p className="soft">{texts.noTool}</p>;
  const [x, y] = rulersMm;
  const rulers = typeof x === "number" && typeof y === "number" ? ([x, y] as [number, number]) : null;
  const begin = (): void => {
    void beginning
      .run(async () => {
        const text = plate === null ? null : await plate.text();
        await postCertificatesCollection({
          body: { tool: chosen, plate: text, rulers_mm: rulers, ruler_sd_mm: RULER_SD_MM },
        });
      })
      .then((done) => {
        if (done) onBegun();
      });
  };
  return (
    <div className="stack" data-testid="accuracy-begin">
      <p className="soft">{texts.testLead}</p>
      <div className="row">
        <Button
          size="lg"
          variant="default"
          component="a"
          href="/api/certificates/plate.pdf"
          target="_blank"
          rel="noreferrer"
        >
          {texts.print}
        </Button>
        <FileButton
          accept=".yaml,.yml,.json"
          testId="plate-file"
          onFiles={([file]) => {
            setPlate(file ?? null);
          }}
        >
          {texts.plateFile}
        </FileButton>
        {plate !== null && (
          <Button
            size="lg"
            variant="default"
            onClick={() => {
              setPlate(null);
            }}
          >
            {texts.defaultPlate}
          </Button>
        )}
      </div>
      {plate !== null && <p>{interpolate(texts.plateChosen, { name: plate.name })}</p>}
      {tools.length > 1 && (
        <SegmentedControl
          size="lg"
          aria-label={texts.tool}
          data={[...tools]}
          value={chosen}
          onChange={setTool}
        />
      )}
      <div className="row">
        <RulerInput
          label={texts.rulerX}
          hint={texts.rulersHint}
          value={x}
          onChange={(one) => {
            setRulersMm([one, y]);
          }}
        />
        <RulerInput
          label={texts.rulerY}
          hint={texts.rulersHint}
          value={y}
          onChange={(one) => {
            setRulersMm([x, one]);
          }}
        />
        <Button
          size="lg"
          disabled={rulers === null && plate === null}
          loading={beginning.busy}
          data-testid="accuracy-start"
          onClick={begin}
        >
          {texts.begin}
        </Button>
      </div>
      <RejectionNote rejection={beginning.rejection} />
    </div>
  );
}

interface RulerInputProps {
  label: string;
  hint: string;
  value: number | string;
  onChange: (value: number | string) => void;
}

function RulerInput({ label, hint, value, onChange }: RulerInputProps): ReactNode {
  return (
    <NumberInput
      hideControls
      inputMode="decimal"
      className="grow"
      size="lg"
      label={`${label} (mm)`}
      description={hint}
      min={1}
      max={1250}
      decimalScale={2}
      value={value}
      onChange={onChange}
    />
  );
}
