import type { ReactNode } from "react";
import { Drawing, type DrawingName } from "./Drawing";

interface EmptyStateProps {
  drawing: DrawingName;
  /** One sentence. */
  sentence: string;
  testId?: string;
  /** The button of the remedy, where there is one. */
  children?: ReactNode;
}

/** What a place shows instead of content: a drawing, one sentence, and the remedy. */
export function EmptyState({ drawing, sentence, testId, children }: EmptyStateProps): ReactNode {
  return (
    <div className="empty-state" data-testid={testId}>
      <Drawing name={drawing} />
      <p>{sentence}</p>
      {children}
    </div>
  );
}
