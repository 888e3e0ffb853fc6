import type { ReactNode } from "react";
import { Brand } from "../panes/Brand";
import { LiveStatus } from "../panes/LiveStatus";
import { Watching } from "../room/Watching";
import { MoreDetails } from "./MoreDetails";
import { Navigated } from "./Navigated";

/** What is navigated, who watches, and whether all of it is there. */
export function TheatreTop(): ReactNode {
  return (
    <header className="top">
      <Brand />
      <Navigated />
      <Watching />
      <LiveStatus />
      <div className="top-tools">
        <MoreDetails />
      </div>
    </header>
  );
}
