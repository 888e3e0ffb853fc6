import { Button, SegmentedControl } from "@mantine/core";
import type { ReactNode } from "react";
import { useTexts } from "../../../texts/TextsContext";
import { StepActions } from "../../StepActions";
import { RehearsalStrip } from "../RehearsalStrip";
import { StepField } from "../StepField";
import { viewOfTruth, type RuledView } from "./ruler";

interface RulerFormProps {
  view: RuledView;
  onView: (view: RuledView) => void;
  /** Of the needles, for the rehearsal's simulated ruler. */
  middleMm: readonly number[];
  done: boolean;
  onDone: () => void;
}

/** Camera position by ruler: height above and distance beside the vertebra, and the patient's end. */
export function RulerForm({ view, onView, middleMm, done, onDone }: RulerFormProps): ReactNode {
  const texts = useTexts().registration.ruler;
  const fields = [
    { name: "vertical_mm", label: texts.vertical, unit: "mm", min: 20, max: 3000, step: 10 },
    { name: "horizontal_mm", label: texts.horizontal, unit: "mm", min: 1, max: 3000, step: 10 },
    { name: "azimuth_deg", label: texts.azimuth, unit: "°", min: -180, max: 180, step: 5 },
  ] as const;
  return (
    <section className="card ruler" data-testid="ruler">
      <h3>{texts.title}</h3>
      <p>{texts.hint}</p>
      <RehearsalStrip scenes={["landmarks"]}>
        {(rehearsal) => (
          <Button
            size="md"
            variant="default"
            disabled={!rehearsal.truth?.moment}
            data-testid="ruler-rehearsed"
            onClick={() => {
              if (rehearsal.truth?.moment)
                onView(viewOfTruth(rehearsal.truth.moment.camera_from_vertebra, middleMm));
            }}
          >
            {texts.rehearsed}
          </Button>
        )}
      </RehearsalStrip>
      <div className="row">
        {fields.map(({ name, label, unit, ...bounds }) => (
          <StepField
            key={name}
            label={`${label} [${unit}]`}
            value={view[name]}
            {...bounds}
            testId={`ruler-${name}`}
            onValue={(value) => {
              onView({ ...view, [name]: value });
            }}
          />
        ))}
      </div>
      <p>{texts.viewedFrom}</p>
      <SegmentedControl
        size="lg"
        aria-label={texts.viewedFrom}
        value={view.patient_end}
        data={[
          { value: "feet", label: texts.feet },
          { value: "head", label: texts.head },
        ]}
        onChange={(value) => {
          onView({ ...view, patient_end: value === "head" ? "head" : "feet" });
        }}
      />
      <p className="quiet">{texts.said}</p>
      {!done && (
        <StepActions>
          <Button size="xl" onClick={onDone} data-testid="ruler-done">
            {texts.done}
          </Button>
        </StepActions>
      )}
    </section>
  );
}
