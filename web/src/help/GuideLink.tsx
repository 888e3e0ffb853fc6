import type { ReactNode } from "react";
import { guideAddress, type GuidePlace } from "./guide";

/** A link to the guide at this place, in a tab of its own: the page keeps running. */
export function GuideLink({ place, children }: { place: GuidePlace; children: ReactNode }): ReactNode {
  return (
    <a className="big-link" href={guideAddress(place)} target="_blank" rel="noreferrer" data-testid="guide">
      {children}
    </a>
  );
}
