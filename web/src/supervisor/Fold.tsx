import { useState, type ReactNode } from "react";

interface FoldProps {
  id: string;
  title: string;
  /** Said beside the title, open or not. */
  aside?: ReactNode;
  open?: boolean;
  children: ReactNode;
}

/** A part of the page whose inside is there, and asked for, only while it is open. */
export function Fold({ id, title, aside, open = false, children }: FoldProps): ReactNode {
  const [isOpen, setOpen] = useState(open);
  return (
    <details
      className="fold"
      data-testid={`fold-${id}`}
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
