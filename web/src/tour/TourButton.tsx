import type { ReactNode } from "react";
import { useTexts } from "../texts/TextsContext";
import { useTour } from "./TourContext";

/** Starts the tour again; nothing where it may not run, and while it runs. */
export function TourButton(): ReactNode {
  const texts = useTexts().tour;
  const tour = useTour();
  if (tour?.at !== null) return null;
  return (
    <button
      type="button"
      className="help-button"
      title={texts.again}
      onClick={() => {
        tour.show(0);
      }}
      data-testid="tour-start"
    >
      {texts.title}
    </button>
  );
}
