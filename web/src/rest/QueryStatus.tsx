import { Button, Loader } from "@mantine/core";
import type { ReactNode } from "react";
import { useTexts } from "../texts/TextsContext";
import { RejectionNote } from "./RejectionNote";
import type { QueryState } from "./useQuery";

interface QueryStatusProps {
  query: Pick<QueryState<unknown>, "rejection" | "refetch">;
  /** How a refusal is shown. */
  Note?: typeof RejectionNote;
}

/** In place of an answer that is not there: that it is awaited, or why it failed and a way to ask again. */
export function QueryStatus({
  query: { rejection, refetch },
  Note = RejectionNote,
}: QueryStatusProps): ReactNode {
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
      <Button size="lg" variant="default" onClick={refetch}>
        {texts.again}
      </Button>
    </div>
  );
}
