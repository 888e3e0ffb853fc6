import { Button } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { useTexts } from "../../../texts/TextsContext";
import { interpolate } from "../../../texts/interpolate";
import type { PlannedVertebra } from "../planReader";

const NEEDLES = 3;

interface PlacesFormProps {
  vertebra: PlannedVertebra;
  chosen: readonly string[];
  /** Empty: the lines of the reference slice. */
  onChosen: (landmarks: string[]) => void;
}

/** Places of the needles: the three lines of the reference slice, or landmarks of the plan. */
export function PlacesForm({ vertebra, chosen, onChosen }: PlacesFormProps): ReactNode {
  const texts = useTexts().registration.places;
  const [names, setNames] = useState<readonly string[]>(chosen);
  return (
    <section className="card" data-testid="places">
      <h3>{texts.title}</h3>
      <Button
        size="lg"
        variant={chosen.length === 0 && vertebra.hasReference ? "filled" : "default"}
        disabled={!vertebra.hasReference}
        data-testid="places-lines"
        onClick={() => {
          onChosen([]);
        }}
      >
        {texts.lines}
      </Button>
      {!vertebra.hasReference && <p className="warning">▲ {texts.noReference}</p>}
      <p>{interpolate(texts.orLandmarks, { count: NEEDLES })}</p>
      <div className="row">
        {vertebra.landmarks.map((one) => {
          const at = names.indexOf(one.name);
          return (
            <Button
              key={one.name}
              size="md"
              variant={at < 0 ? "default" : "light"}
              aria-pressed={at >= 0}
              onClick={() => {
                setNames(at < 0 ? [...names, one.name] : names.filter((name) => name !== one.name));
              }}
            >
              {at < 0 ? "" : `${at + 1} · `}
              {one.name}
            </Button>
          );
        })}
      </div>
      <Button
        size="lg"
        disabled={names.length < NEEDLES}
        data-testid="places-landmarks"
        onClick={() => {
          onChosen([...names]);
        }}
      >
        {texts.useLandmarks}
      </Button>
    </section>
  );
}
