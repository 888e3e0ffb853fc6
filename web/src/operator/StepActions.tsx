import { createContext, useContext, useState, type ReactNode } from "react";
import { createPortal } from "react-dom";

const BarContext = createContext<HTMLElement | null>(null);

/** The content of a step's page above the bar of its main buttons, which stays in sight while the content scrolls. */
export function WithStepActions({ children }: { children: ReactNode }): ReactNode {
  const [bar, setBar] = useState<HTMLElement | null>(null);
  return (
    <BarContext value={bar}>
      <div className="step-content">{children}</div>
      <div className="step-actions" ref={setBar} data-testid="step-actions" />
    </BarContext>
  );
}

/** Buttons of the step's bar: others first, the main one last, which stands at its right end. */
export function StepActions({ children }: { children: ReactNode }): ReactNode {
  const bar = useContext(BarContext);
  return bar === null ? null : createPortal(children, bar);
}
