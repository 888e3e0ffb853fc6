import { useState, type ReactNode } from "react";

interface FoldProps {
  id: string;
  title: string;
  /** Shown beside the title, open or closed. */
  aside?: ReactNode;
  open?: boolean;
  /** Of the folds with this name one is open. */
  group?: string;
  children: ReactNode;
}

/** A section that mounts its content, and so requests its data, only while it is open. */
export function Fold({ id, title, aside, open = false, group, children }: FoldProps): ReactNode {
  const [isOpen, setOpen] = useState(open);
  return (
    <details
      className="fold"
      data-testid={`fold-${id}`}
      name={group}
      open={isOpen}
      onToggle={(event) => {
        setOpen(event.currentTarget.open);
      }}
    >
      <summary>
        <h2>{title}</h2>
        {aside}
      </summary>
      {isOpen && <div className="fold-inside">{children}</div>}
    </details>
  );
}
