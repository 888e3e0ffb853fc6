import { Button, NumberInput } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { putCameraReadout } from "../../api";
import { RejectionNote } from "../../rest/RejectionNote";
import { useAction } from "../../rest/useAction";
import { useTexts } from "../../texts/TextsContext";
import { useMaker } from "../parts/useMaker";

interface StatedReadoutProps {
  readoutMs: number | null;
  onStored: () => void;
}

/** Readout time from the data sheet; empty means unknown. */
export function StatedReadout({ readoutMs, onStored }: StatedReadoutProps): ReactNode {
  const texts = useTexts().camera.readout;
  const madeBy = useMaker();
  const keeping = useAction();
  const [typed, setTyped] = useState<number | string>(readoutMs ?? "");
  const keep = (): void => {
    const readout_ms = typeof typed === "number" ? typed : null;
    void keeping
      .run(async () => {
        await putCameraReadout({ body: { readout_ms, made_by: madeBy } });
      })
      .then(onStored);
  };
  return (
    <>
      <NumberInput
        hideControls
        inputMode="decimal"
        size="lg"
        label={texts.field}
        description={texts.fieldHint}
        placeholder={texts.unknown}
        min={0}
        max={200}
        decimalScale={2}
        value={typed}
        data-testid="readout-ms"
        onChange={setTyped}
      />
      <div>
        <Button size="lg" variant="default" loading={keeping.busy} data-testid="keep-readout" onClick={keep}>
          {texts.keep}
        </Button>
      </div>
      <RejectionNote rejection={keeping.rejection} />
    </>
  );
}
