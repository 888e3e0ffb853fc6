import { useState, type ReactNode } from "react";
import { useTexts } from "../../texts/TextsContext";
import { Card } from "../parts/Card";
import { FileButton } from "../parts/FileButton";
import { interpolate } from "../../texts/interpolate";
import { uploadFile } from "../parts/transfer";
import { TransferProgress } from "../parts/TransferProgress";
import { useTransfer } from "../parts/useTransfer";
import type { ImportedCaseMessage } from "../../api";
import { DamageList } from "./DamageList";

/** Imports a case from an archive, completely or not at all. */
export function ArchiveIn({ onTaken }: { onTaken: () => void }): ReactNode {
  const texts = useTexts().case;
  const [taken, setTaken] = useState<ImportedCaseMessage | null>(null);
  const transfer = useTransfer();
  const take = (file: File): void => {
    setTaken(null);
    void transfer.run(async (onMoved, signal) => {
      const body = new Blob([file], { type: "application/zip" });
      setTaken(await uploadFile<ImportedCaseMessage>("/api/cases/archive", body, onMoved, signal));
      onTaken();
    });
  };
  return (
    <Card title={texts.archiveInTitle} testId="archive-in">
      <p className="soft">{texts.archiveInLead}</p>
      <div>
        <FileButton
          accept=".zip,application/zip"
          disabled={transfer.moved !== null}
          testId="archive-file"
          onFiles={([file]) => {
            if (file !== undefined) take(file);
          }}
        >
          {texts.archiveIn}
        </FileButton>
      </div>
      <TransferProgress transfer={transfer} name={texts.archiveIn} />
      {taken !== null && <p role="status">{interpolate(texts.archiveTaken, { name: taken.name })}</p>}
      {taken !== null && taken.damages.length > 0 && (
        <div role="alert" className="bad stack">
          <p>▲ {texts.archiveIncomplete}</p>
          <DamageList damages={taken.damages} />
        </div>
      )}
    </Card>
  );
}
