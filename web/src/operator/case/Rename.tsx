import { Button, TextInput } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { patchCasesByCaseId } from "../../api";
import { RejectionNote } from "../../rest/RejectionNote";
import { useAction } from "../../rest/useAction";
import { useTexts } from "../../texts/TextsContext";
import type { Case } from "./OpenedCase";

/** Renames a case, with undo. */
export function Rename({ case_, onRenamed }: { case_: Case; onRenamed: () => void }): ReactNode {
  const texts = useTexts().case;
  const [name, setName] = useState<string | null>(null);
  const [before, setBefore] = useState<string | null>(null);
  const renaming = useAction();
  const rename = async (to: string): Promise<void> => {
    const was = case_.name;
    const done = await renaming.run(async () => {
      const path = { case_id: case_.id };
      await patchCasesByCaseId({ path, body: { name: to } });
    });
    if (!done) return;
    setBefore(before === null ? was : null);
    setName(null);
    onRenamed();
  };
  if (name === null) {
    return (
      <div className="row row-mid">
        <p className="case-name grow">{case_.name}</p>
        {before !== null && (
          <Button size="lg" variant="subtle" onClick={() => void rename(before)}>
            {texts.undoRename}
          </Button>
        )}
        <Button
          size="lg"
          variant="subtle"
          onClick={() => {
            setName(case_.name);
          }}
        >
          {texts.rename}
        </Button>
        <RejectionNote rejection={renaming.rejection} />
      </div>
    );
  }
  return (
    <form
      className="row"
      onSubmit={(event) => {
        event.preventDefault();
        void rename(name.trim());
      }}
    >
      <TextInput
        className="grow"
        size="lg"
        label={texts.name}
        data-autofocus
        maxLength={200}
        value={name}
        onChange={(event) => {
          setName(event.currentTarget.value);
        }}
      />
      <Button type="submit" size="lg" disabled={name.trim() === ""} loading={renaming.busy}>
        {texts.keepName}
      </Button>
      <Button
        size="lg"
        variant="default"
        onClick={() => {
          setName(null);
        }}
      >
        {texts.leaveName}
      </Button>
      <RejectionNote rejection={renaming.rejection} />
    </form>
  );
}
