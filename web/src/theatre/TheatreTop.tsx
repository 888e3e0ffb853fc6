import type { ReactNode } from "react";
import { Brand } from "../panes/Brand";
import { LiveStatus } from "../panes/LiveStatus";
import { MoreDetails } from "./MoreDetails";
import { Navigated } from "./Navigated";

/** What is navigated, who watches, and whether all of it is there. */
export function TheatreTop({ watching }: { watching?: ReactNode }): ReactNode {
  return (
    <header className="top">
      <Brand />
      <Navigated />
      <LiveStatus />
      <div className="top-tools">
        {watching}
        <MoreDetails />
      </div>
    </header>
  );
}
