import { Button, Checkbox } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { useTexts } from "../../texts/TextsContext";
import { saved } from "../parts/saved";
import { downloadFile } from "../parts/transfer";
import { TransferProgress } from "../parts/TransferProgress";
import { useTransfer } from "../parts/useTransfer";

/** Saves the case as one file; the patient's identity only on request. */
export function ArchiveOut({ caseId }: { caseId: string }): ReactNode {
  const texts = useTexts().case;
  const [withIdentity, setWithIdentity] = useState(false);
  const transfer = useTransfer();
  const copyOut = (): void => {
    void transfer.run(async (onMoved, signal) => {
      const path = `/api/cases/${caseId}/archive?with_identity=${String(withIdentity)}`;
      saved(await downloadFile(path, onMoved, signal), `coaxial-case-${caseId.slice(0, 6)}.zip`);
    });
  };
  return (
    <div className="stack grow" data-testid="archive-out">
      <div className="row row-mid">
        <Button size="lg" variant="default" disabled={transfer.moved !== null} onClick={copyOut}>
          {texts.copyOut}
        </Button>
        <Checkbox
          size="lg"
          label={texts.withIdentity}
          checked={withIdentity}
          onChange={(event) => {
            setWithIdentity(event.currentTarget.checked);
          }}
        />
      </div>
      <TransferProgress transfer={transfer} name={texts.copyOut} />
    </div>
  );
}
