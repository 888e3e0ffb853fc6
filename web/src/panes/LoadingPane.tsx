import type { ReactNode } from "react";
import { useTexts } from "../texts/TextsContext";

/** Placeholder for a live pane while the page is loading. */
export function LoadingPane({ id, title }: { id: string; title: string }): ReactNode {
  const texts = useTexts().rest;
  return (
    <section className={`pane pane-${id}`} id={id} aria-label={title} aria-busy="true" tabIndex={-1}>
      <p className="loading" data-testid={`${id}-loading`}>
        {texts.loading}
      </p>
    </section>
  );
}
