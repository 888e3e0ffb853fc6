import { Button } from "@mantine/core";
import type { ReactNode } from "react";
import { RejectionNote } from "../../rest/RejectionNote";
import { useAction } from "../../rest/useAction";
import { type CaseMessage, postCasesByCaseIdClose } from "../../api";
import { useTexts } from "../../texts/TextsContext";
import { Card } from "../parts/Card";
import { formatTime } from "../parts/format";
import { ArchiveOut } from "./ArchiveOut";
import { Rename } from "./Rename";

export type Case = CaseMessage;

/** The open case: name, archive, and close button. */
export function OpenedCase({ opened, onChange }: { opened: Case; onChange: () => void }): ReactNode {
  const texts = useTexts();
  const closing = useAction();
  const close = (): void => {
    void closing
      .run(async () => {
        const path = { case_id: opened.id };
        await postCasesByCaseIdClose({ path });
      })
      .then(onChange);
  };
  return (
    <Card
      title={texts.case.openTitle}
      testId="opened-case"
      aside={<span className="badge-good">● {texts.case.isOpen}</span>}
    >
      <Rename case_={opened} onRenamed={onChange} />
      <p className="soft">
        {texts.case.madeAt} {formatTime(opened.created_at, texts.language)} · {texts.case.changedAt}{" "}
        {formatTime(opened.changed_at, texts.language)}
        {opened.copied_from !== null && ` · ${texts.case.cameAsArchive}`}
      </p>
      <div className="row">
        <ArchiveOut key={opened.id} caseId={opened.id} />
        <Button size="lg" variant="default" loading={closing.busy} onClick={close}>
          {texts.case.close}
        </Button>
      </div>
      <RejectionNote rejection={closing.rejection} />
    </Card>
  );
}
