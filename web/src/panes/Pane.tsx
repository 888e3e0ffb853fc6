import type { ReactNode, Ref } from "react";

interface PaneProps {
  id: string;
  title: string;
  aside?: ReactNode;
  ref?: Ref<HTMLElement>;
  children: ReactNode;
}

/** A section of the page with its title. */
export function Pane({ id, title, aside, ref, children }: PaneProps): ReactNode {
  return (
    <section className={`pane pane-${id}`} id={id} aria-labelledby={`${id}-title`} ref={ref} tabIndex={-1}>
      <header className="pane-head">
        <h2 id={`${id}-title`}>{title}</h2>
        {aside}
      </header>
      {children}
    </section>
  );
}
