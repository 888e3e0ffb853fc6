import { Button, Checkbox } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { postCasesByCaseIdVerification, type DamageMessage } from "../../api";
import { Rejection } from "../../rest/client";
import { useTexts } from "../../texts/TextsContext";
import { saved } from "../parts/saved";
import { downloadFile } from "../parts/transfer";
import { TransferProgress } from "../parts/TransferProgress";
import { useTransfer } from "../parts/useTransfer";
import { DamageList } from "./DamageList";

const OF_DAMAGE = ["FILE_DAMAGED", "DOCUMENT_DAMAGED"];

/** Saves the case as one file; the patient's identity, and an incomplete case, only on request. */
export function ArchiveOut({ caseId }: { caseId: string }): ReactNode {
  const texts = useTexts().case;
  const [withIdentity, setWithIdentity] = useState(false);
  const [damages, setDamages] = useState<readonly DamageMessage[]>([]);
  const transfer = useTransfer();
  const copyOut = (options: { withoutDamaged: boolean }): void => {
    setDamages([]);
    void transfer.run(async (onMoved, signal) => {
      const { withoutDamaged } = options;
      const query = `with_identity=${String(withIdentity)}&without_damaged=${String(withoutDamaged)}`;
      const name = `coaxial-case-${caseId.slice(0, 6)}${withoutDamaged ? "-incomplete" : ""}.zip`;
      try {
        saved(await downloadFile(`/api/cases/${caseId}/archive?${query}`, onMoved, signal), name);
      } catch (error) {
        if (error instanceof Rejection && OF_DAMAGE.includes(error.problem.code)) {
          const path = { case_id: caseId };
          setDamages((await postCasesByCaseIdVerification({ path, signal })).damages);
        }
        throw error;
      }
    });
  };
  return (
    <div className="stack grow" data-testid="archive-out">
      <div className="row row-mid">
        <Button
          size="lg"
          variant="default"
          disabled={transfer.moved !== null}
          onClick={() => {
            copyOut({ withoutDamaged: false });
          }}
        >
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
      {damages.length > 0 && (
        <div role="alert" className="bad stack">
          <p>▲ {texts.copyOutDamaged}</p>
          <DamageList damages={damages} />
          <div>
            <Button
              size="lg"
              variant="default"
              onClick={() => {
                copyOut({ withoutDamaged: true });
              }}
            >
              {texts.copyOutIntact}
            </Button>
          </div>
        </div>
      )}
    </div>
  );
}
