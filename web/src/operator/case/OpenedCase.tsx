import { Button } from "@mantine/core";
import type { ReactNode } from "react";
import { answered, server } from "../../rest/client";
import { RejectionNote } from "../../rest/RejectionNote";
import { useDo } from "../../rest/useDo";
import type { components } from "../../schema";
import { useWords } from "../../words/WordsContext";
import { Card } from "../parts/Card";
import { shownTime } from "../parts/shown";
import { ArchiveOut } from "./ArchiveOut";
import { Rename } from "./Rename";

export type Case = components["schemas"]["CaseMessage"];

/** The case that is open: its name, its archive, and the way out of it. */
export function OpenedCase({ opened, onChange }: { opened: Case; onChange: () => void }): ReactNode {
  const words = useWords();
  const closing = useDo();
  const close = (): void => {
    void closing
      .run(async () => {
        const params = { path: { case_id: opened.id } };
        await answered(server.POST("/api/cases/{case_id}/close", { params }));
      })
      .then(onChange);
  };
  return (
    <Card
      title={words.case.openTitle}
      testId="opened-case"
      aside={<span className="badge-good">● {words.case.isOpen}</span>}
    >
      <Rename case_={opened} onRenamed={onChange} />
      <p className="soft">
        {words.case.madeAt} {shownTime(opened.created_at, words.language)} · {words.case.changedAt}{" "}
        {shownTime(opened.changed_at, words.language)}
        {opened.copied_from !== null && ` · ${words.case.cameAsArchive}`}
      </p>
      <div className="row">
        <ArchiveOut caseId={opened.id} />
        <Button size="lg" variant="default" loading={closing.busy} onClick={close}>
          {words.case.close}
        </Button>
      </div>
      <RejectionNote rejection={closing.rejection} />
    </Card>
  );
}
