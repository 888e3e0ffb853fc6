import type { ReactNode } from "react";
import { useTexts } from "../texts/TextsContext";
import { TourButton } from "../tour/TourButton";
import { guideAddress, type GuidePlace } from "./guide";

/** The `?` of a page: opens the guide at its place, in a tab of its own. In the rehearsal, beside it the tour. */
export function HelpButton({ place }: { place: GuidePlace }): ReactNode {
  const texts = useTexts().help;
  return (
    <span className="help">
      <a
        className="help-button"
        href={guideAddress(place)}
        target="_blank"
        rel="noreferrer"
        title={texts.open}
        aria-label={texts.open}
        data-testid="help"
      >
        ?
      </a>
      <TourButton />
    </span>
  );
}
