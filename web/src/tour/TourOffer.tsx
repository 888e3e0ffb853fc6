import { Button } from "@mantine/core";
import type { ReactNode } from "react";
import { Card } from "../operator/parts/Card";
import { useTexts } from "../texts/TextsContext";
import { useTour } from "./TourContext";

/** Offers the tour to whoever has not left it yet; only in the rehearsal. */
export function TourOffer(): ReactNode {
  const texts = useTexts().tour;
  const tour = useTour();
  if (tour === null || tour.wasLeft || tour.at !== null) return null;
  return (
    <Card title={texts.offer.title} testId="tour-offer">
      <p>{texts.offer.sentence}</p>
      <div className="row">
        <Button
          size="lg"
          onClick={() => {
            tour.show(0);
          }}
        >
          {texts.offer.start}
        </Button>
        <Button size="lg" variant="default" onClick={tour.leave}>
          {texts.offer.later}
        </Button>
      </div>
    </Card>
  );
}
