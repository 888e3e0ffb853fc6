import { Button, TextInput } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { postCasesByCaseIdDeletion } from "../../api";
import { Dialog } from "../../panes/Dialog";
import { RejectionNote } from "../../rest/RejectionNote";
import { useAction } from "../../rest/useAction";
import { useTexts } from "../../texts/TextsContext";
import type { Case } from "./OpenedCase";

/** Deletes a case after its name was typed, since it cannot be restored. */
export function DeleteCase({ leaving, onEnd }: { leaving: Case; onEnd: () => void }): ReactNode {
  const texts = useTexts().case;
  const [confirm, setConfirm] = useState("");
  const deleting = useAction();
  const remove = async (): Promise<void> => {
    const done = await deleting.run(async () => {
      const path = { case_id: leaving.id };
      await postCasesByCaseIdDeletion({ path, body: { confirm } });
    });
    if (done) onEnd();
  };
  return (
    <Dialog
      opened
      centered
      size="lg"
      onClose={onEnd}
      title={texts.deleteTitle}
      closeButtonProps={{ size: "xl", "aria-label": texts.keepCase }}
    >
      <form
        className="stack"
        onSubmit={(event) => {
          event.preventDefault();
          void remove();
        }}
      >
        <p>{texts.deleteLead}</p>
        <p className="case-name">{leaving.name}</p>
        <TextInput
          size="lg"
          label={texts.deleteConfirm}
          autoComplete="off"
          value={confirm}
          onChange={(event) => {
            setConfirm(event.currentTarget.value);
          }}
        />
        <RejectionNote rejection={deleting.rejection} />
        <div className="row">
          <Button size="lg" variant="default" data-autofocus onClick={onEnd}>
            {texts.keepCase}
          </Button>
          <Button
            type="submit"
            size="lg"
            color="red"
            disabled={confirm !== leaving.name}
            loading={deleting.busy}
          >
            {texts.deleteForEver}
          </Button>
        </div>
      </form>
    </Dialog>
  );
}
