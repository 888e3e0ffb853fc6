import { Button } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { postCasesByCaseIdOpen } from "../../api";
import { RejectionNote } from "../../rest/RejectionNote";
import { useAction } from "../../rest/useAction";
import { useTexts } from "../../texts/TextsContext";
import { Card } from "../parts/Card";
import { formatTime } from "../parts/format";
import { DeleteCase } from "./DeleteCase";
import { Rename } from "./Rename";
import type { Case } from "./OpenedCase";

interface CaseListProps {
  cases: readonly Case[];
  openedId: string | null;
  onChange: () => void;
}

/** The other cases, to open or delete. */
export function CaseList({ cases, openedId, onChange }: CaseListProps): ReactNode {
  const texts = useTexts();
  const opening = useAction();
  const [leaving, setLeaving] = useState<Case | null>(null);
  const others = cases.filter((one) => one.id !== openedId);
  const open = (id: string): void => {
    void opening
      .run(async () => {
        await postCasesByCaseIdOpen({ path: { case_id: id } });
      })
      .then(onChange);
  };
  if (others.length === 0) return null;
  return (
    <Card title={texts.case.listTitle} testId="case-list">
      <ul className="rows">
        {others.map((one) => (
          <li key={one.id} className="row">
            <div className="grow">
              {one.is_damaged ? (
                <>
                  <Rename case_={one} onRenamed={onChange} />
                  <p className="bad">▲ {texts.case.damagedCase}</p>
                </>
              ) : (
                <>
                  <p className="case-name">{one.name}</p>
                  <p className="soft">
                    {texts.case.changedAt} {formatTime(one.changed_at, texts.language)}
                  </p>
                </>
              )}
            </div>
            <Button
              size="lg"
              disabled={one.is_damaged}
              loading={opening.busy}
              onClick={() => {
                open(one.id);
              }}
            >
              {texts.case.open}
            </Button>
            <Button
              size="lg"
              variant="subtle"
              color="red"
              onClick={() => {
                setLeaving(one);
              }}
            >
              {texts.case.delete}
            </Button>
          </li>
        ))}
      </ul>
      {openedId !== null && <p className="soft">{texts.case.oneIsClosed}</p>}
      <RejectionNote rejection={opening.rejection} />
      {leaving !== null && (
        <DeleteCase
          key={leaving.id}
          leaving={leaving}
          onEnd={() => {
            setLeaving(null);
            onChange();
          }}
        />
      )}
    </Card>
  );
}
