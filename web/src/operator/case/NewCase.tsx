import { Button, TextInput } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { postCases, postCasesByCaseIdOpen } from "../../api";
import { RejectionNote } from "../../rest/RejectionNote";
import { useAction } from "../../rest/useAction";
import { useTexts } from "../../texts/TextsContext";
import { Card } from "../parts/Card";

/** Creates a case and opens it; prominent if there is none yet. */
export function NewCase({ first, onMade }: { first: boolean; onMade: () => void }): ReactNode {
  const texts = useTexts().case;
  const [name, setName] = useState("");
  const making = useAction();
  const make = async (): Promise<void> => {
    const done = await making.run(async () => {
      const made = await postCases({ body: { name: name.trim() } });
      await postCasesByCaseIdOpen({ path: { case_id: made.id } });
    });
    // Refreshed even if only opening was rejected, since the case then exists.
    onMade();
    if (done) setName("");
  };
  return (
    <Card title={first ? texts.firstTitle : texts.newTitle} testId="new-case">
      {first && <p className="card-lead">{texts.firstLead}</p>}
      <form
        className="row"
        onSubmit={(event) => {
          event.preventDefault();
          void make();
        }}
      >
        <TextInput
          className="grow"
          size="lg"
          label={texts.name}
          description={texts.nameHint}
          maxLength={200}
          value={name}
          onChange={(event) => {
            setName(event.currentTarget.value);
          }}
        />
        <Button type="submit" size="lg" disabled={name.trim() === ""} loading={making.busy}>
          {texts.make}
        </Button>
      </form>
      <RejectionNote rejection={making.rejection} />
    </Card>
  );
}
