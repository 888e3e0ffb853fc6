import type { ReactNode } from "react";
import { Icon } from "../../../panes/Icon";
import { useTexts } from "../../../texts/TextsContext";
import type { PlaneName } from "./address";
import { MeasureNote } from "./MeasureNote";
import type { Projection } from "./projection";
import { useSlices } from "./SlicesContext";
import { SliceTools } from "./SliceTools";
import { SliceView } from "./SliceView";

const ALL: readonly PlaneName[] = ["axial", "sagittal", "coronal", "along", "across"];

interface PlanesProps {
  drawing: (plane: PlaneName, projection: Projection) => ReactNode;
}

/** One plane large, the others small beside it, all through the cross. */
export function Planes({ drawing }: PlanesProps): ReactNode {
  const texts = useTexts().plan.slices;
  const { plane, setPlane, look } = useSlices();
  const there = ALL.filter((one) => look.way !== null || (one !== "along" && one !== "across"));
  return (
    <section className="planes" aria-label={texts.title}>
      <div className="planes-large">
        <SliceView key={plane} plane={plane} isLarge drawing={(projection) => drawing(plane, projection)} />
        <MeasureNote />
      </div>
      <div className="planes-small">
        {there
          .filter((one) => one !== plane)
          .map((one) => (
            <div key={one} className="planes-one">
              <SliceView plane={one} isLarge={false} drawing={(projection) => drawing(one, projection)} />
              <button
                type="button"
                className="planes-enlarge"
                aria-label={texts.enlarge[one]}
                data-testid={`enlarge-${one}`}
                onClick={() => {
                  setPlane(one);
                }}
              >
                <Icon name="enlarge" />
              </button>
            </div>
          ))}
      </div>
      <SliceTools />
    </section>
  );
}
