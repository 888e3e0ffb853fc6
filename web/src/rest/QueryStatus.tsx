import { Button, Loader } from "@mantine/core";
import type { ReactNode } from "react";
import { useTexts } from "../texts/TextsContext";
import { RejectionNote } from "./RejectionNote";
import type { QueryState } from "./useQuery";

interface QueryStatusProps {
  query: Pick<QueryState<unknown>, "rejection" | "refetch">;
  /** Renders a rejection. */
  Note?: typeof RejectionNote;
}

/** Shown while a query has no data: loading, or the reason of the failure with a button that fetches again. */
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
