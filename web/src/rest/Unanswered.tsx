import { Button, Loader } from "@mantine/core";
import type { ReactNode } from "react";
import { useTexts } from "../texts/TextsContext";
import { RejectionNote } from "./RejectionNote";
import type { Asked } from "./useAsked";

interface UnansweredProps {
  asked: Pick<Asked<unknown>, "rejection" | "again">;
  /** How a refusal is shown. */
  Note?: typeof RejectionNote;
}

/** In place of an answer that is not there: that it is awaited, or why it failed and a way to ask again. */
export function Unanswered({
  asked: { rejection, again },
  Note = RejectionNote,
}: UnansweredProps): ReactNode {
  const texts = useTexts().rest;
  if (rejection === null)
    return (
      <p className="loading" role="status">
        <Loader size="sm" color="gray" aria-hidden="true" /> {texts.loading}
      </p>
    );
  return (
    <div className="stack unanswered">
      <Note rejection={rejection} />
      <Button size="lg" variant="default" onClick={again}>
        {texts.again}
      </Button>
    </div>
  );
}
