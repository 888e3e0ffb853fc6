import { Button } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { formatNumber } from "../../../live/rounding";
import { getPlanProposalsSlice, putPlanVertebraeByNameReference } from "../../../api";
import { RejectionNote } from "../../../rest/RejectionNote";
import { useAction } from "../../../rest/useAction";
import { useTexts } from "../../../texts/TextsContext";
import { useIntoView } from "../../parts/useIntoView";
import { VertebraChooser } from "../pedicle/VertebraChooser";
import { CursorPad } from "../slices/CursorPad";
import { useSlices } from "../slices/SlicesContext";
import { vec3 } from "../slices/vectors";
import { sliceIndexAt } from "../slices/voxels";
import { usePlanning } from "../state/PlanContext";
import { useWork } from "../state/WorkContext";
import { Stepper } from "../Stepper";

const STEP_MM = 0.5;

/** The reference slice of a vertebra and its three needle lines. */
export function LinesPart(): ReactNode {
  const texts = useTexts().plan.lines;
  const { plan, vertebra, change, busy } = usePlanning();
  const { ct, look, goTo, setPlane } = useSlices();
  const { apartMm, setApartMm } = useWork();
  const action = useAction();
  const [isLaidHere, setLaidHere] = useState(false);
  const [reference = null] = vertebra?.references ?? [];
  const laid = useIntoView<HTMLElement>(
    isLaidHere && reference !== null ? String(plan?.heading.version ?? 0) : null,
  );
  if (vertebra === null) return <p>{texts.noVertebra}</p>;
  const { name } = vertebra;
  const showProposal = (): void => {
    void action.run(async () => {
      const query = { vertebra: name };
      const proposed = await getPlanProposalsSlice({ query });
      const middle = vec3(proposed.middle_lps_mm) ?? look.cursor;
      setPlane("axial");
      goTo([middle[0], middle[1], proposed.at_mm]);
    });
  };
  const lay = (): void => {
    const slice_index = sliceIndexAt(ct, look.cursor);
    void change((by) =>
      putPlanVertebraeByNameReference({
        path: { name },
        body: { ...by, slice_index, middle_lps_mm: [...look.cursor], apart_mm: apartMm },
      }),
    ).then(setLaidHere);
  };
  return (
    <>
      <VertebraChooser />
      <p>{texts.hint}</p>
      <Button
        size="lg"
        variant="default"
        fullWidth
        disabled={action.busy}
        data-testid="propose-slice"
        onClick={showProposal}
      >
        {texts.propose}
      </Button>
      <RejectionNote rejection={action.rejection} />
      <CursorPad />
      <Stepper
        name="apart"
        label={texts.apart}
        value={`${formatNumber(apartMm, 1)} mm`}
        onStep={(direction) => {
          setApartMm(Math.min(100, Math.max(1, apartMm + direction * STEP_MM)));
        }}
      />
      <Button size="xl" fullWidth disabled={busy} data-testid="lay-lines" onClick={lay}>
        {reference === null ? texts.lay : texts.layAnew}
      </Button>
      {reference !== null && (
        <figure className="reference" ref={laid}>
          <img
            src={`/api/plan/vertebrae/${encodeURIComponent(name)}/reference.png?version=${plan?.heading.version ?? 0}`}
            alt={texts.alt}
            data-testid="reference"
          />
          <figcaption>
            {texts.slice} {reference.slice_index} · {formatNumber(reference.apart_mm, 1)} mm {texts.toSides}
          </figcaption>
        </figure>
      )}
    </>
  );
}
