import type { ReactNode } from "react";

/** `none` while a page is loading, which is no alarm. */
type Urgency = "medium" | "low" | "none";

const MARKS: Record<Urgency, string> = { medium: "▲▲", low: "●", none: "◌" };

interface CoverProps {
  urgency: Urgency;
  title: string;
  state?: string | undefined;
  sentence: string;
  /** Language of the sentence, where it is not that of the page. */
  lang?: string | undefined;
  children?: ReactNode;
}

/** Large words over content that is not live. Opaque, so that nothing old shows through. */
export function Cover({ urgency, title, state, sentence, lang, children }: CoverProps): ReactNode {
  return (
    <div className="cover" data-urgency={urgency}>
      <p className="cover-title">
        <span aria-hidden="true" className="marks">
          {MARKS[urgency]}
        </span>{" "}
        {title}
      </p>
      {state !== undefined && <p className="cover-state">{state}</p>}
      <p className="cover-sentence" lang={lang}>
        {sentence}
      </p>
      {children}
    </div>
  );
}
