import { Button, NumberInput, TextInput } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { useTexts } from "../../texts/TextsContext";
import { FileButton } from "../parts/FileButton";
import { uploadFile } from "../parts/transfer";
import { TransferProgress } from "../parts/TransferProgress";
import { useMaker } from "../parts/useMaker";
import { useTransfer } from "../parts/useTransfer";
import { NAME, nameFrom } from "../parts/name";
import type { KnownMarker } from "./MarkerRow";

interface Chosen {
  file: File;
  address: string;
}

/** Form for a marker: picture, name, and side of its black square. */
export function NewMarker({
  known,
  onAdded,
}: {
  known: readonly KnownMarker[];
  onAdded: () => void;
}): ReactNode {
  const texts = useTexts().camera;
  const madeBy = useMaker();
  const [chosen, setChosen] = useState<Chosen | null>(null);
  const [name, setName] = useState("");
  const [sideMm, setSideMm] = useState<number | string>("");
  const transfer = useTransfer();
  const same = known.find((one) => one.name === name) ?? null;
  const isReplaced = typeof same?.document_id === "string";
  const nameError =
    name !== "" && !NAME.test(name)
      ? texts.nameWrong
      : same?.document_id === null
        ? texts.nameOfSettings
        : null;
  const ready =
    chosen !== null && NAME.test(name) && nameError === null && typeof sideMm === "number" && sideMm > 0;
  const choose = (file: File | null): void => {
    if (chosen !== null) URL.revokeObjectURL(chosen.address);
    setChosen(file === null ? null : { file, address: URL.createObjectURL(file) });
  };
  const add = (): void => {
    if (!ready) return;
    void transfer.run(async (onMoved, signal) => {
      const query = new URLSearchParams({
        name,
        side_mm: String(sideMm),
        made_by: madeBy,
        file: chosen.file.name,
      });
      await uploadFile(`/api/markers?${query.toString()}`, chosen.file, onMoved, signal);
      choose(null);
      setName("");
      setSideMm("");
      onAdded();
    });
  };
  return (
    <details className="more" open={known.length === 0} data-testid="new-marker">
      <summary>{texts.newMarker}</summary>
      <div className="stack">
        <p className="soft">{texts.newMarkerLead}</p>
        <div className="row">
          {chosen !== null && (
            <img className="marker-chosen" src={chosen.address} alt={texts.pictureChosen} />
          )}
          <FileButton
            accept="image/png,image/jpeg,image/bmp"
            testId="marker-file"
            onFiles={([file]) => {
              if (file === undefined) return;
              choose(file);
              if (name === "") setName(nameFrom(file.name));
            }}
          >
            {chosen === null ? texts.choosePicture : texts.otherPicture}
          </FileButton>
          <TextInput
            className="grow"
            size="lg"
            label={texts.markerName}
            error={nameError}
            value={name}
            onChange={(event) => {
              setName(event.currentTarget.value);
            }}
          />
          <NumberInput
            hideControls
            inputMode="decimal"
            size="lg"
            label={`${texts.side} (mm)`}
            min={0.1}
            max={1000}
            step={1}
            decimalScale={3}
            value={sideMm}
            onChange={setSideMm}
          />
          <Button
            size="lg"
            disabled={!ready || transfer.moved !== null}
            data-testid="add-marker"
            onClick={add}
          >
            {isReplaced ? texts.replaceMarker : texts.addMarker}
          </Button>
        </div>
        {isReplaced && <p className="bad">▲ {texts.replaceHint}</p>}
        <TransferProgress transfer={transfer} name={texts.addMarker} />
      </div>
    </details>
  );
}
