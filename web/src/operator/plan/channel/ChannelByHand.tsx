import { Button, SegmentedControl } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { formatNumber } from "../../../live/rounding";
import { putPlanVertebraeByNameChannelsBySide } from "../../../api";
import { useTexts } from "../../../texts/TextsContext";
import { StepActions } from "../../StepActions";
import { ArrowPad } from "../slices/ArrowPad";
import { downOf, normalOf, rightOf } from "../slices/place";
import { useSlices } from "../slices/SlicesContext";
import { plus, times } from "../slices/vectors";
import { usePlanning } from "../state/PlanContext";
import type { PlannedChannel } from "../state/shape";
import { useWork } from "../state/WorkContext";
import { Stepper } from "../Stepper";
import {
  anglesOf,
  isSame,
  MIN_DIAMETER_MM,
  extendChannel,
  lengthMm,
  MAX_DIAMETER_MM,
  MOVED,
  placeChannel,
  shiftChannel,
  rotateChannel,
  type Draft,
  type Moved,
} from "./draft";

const STEP_MM = 0.5;

interface ChannelByHandProps {
  of: string;
  draft: Draft;
  planned: PlannedChannel | null;
}

/** Moves the channel in steps of 0.5 mm and 1° on the large slice; then saves or discards it. */
export function ChannelByHand({ of, draft, planned }: ChannelByHandProps): ReactNode {
  const texts = useTexts().plan.byHand;
  const { vertebra, side, change, busy } = usePlanning();
  const { setDraft } = useWork();
  const { largePlace, look } = useSlices();
  const [what, setWhat] = useState<Moved>("whole");
  const put = (channel: Draft): void => {
    setDraft({ of, channel });
  };
  const { transverseDeg, sagittalDeg } = anglesOf(draft, side);
  const isUnchanged = planned !== null && isSame(draft, planned.channel);
  const keep = (): void => {
    if (vertebra === null) return;
    const path = { name: vertebra.name, side };
    void change((by) =>
      putPlanVertebraeByNameChannelsBySide({
        path,
        body: {
          ...by,
          by_hand: {
            entry_lps_mm: [...draft.entry],
            target_lps_mm: [...draft.target],
            diameter_mm: draft.diameterMm,
          },
        },
      }),
    ).then((made) => {
      if (made) setDraft(null);
    });
  };
  return (
    <section className="by-hand" aria-label={texts.title} data-testid="by-hand">
      <p>{texts.hint}</p>
      <SegmentedControl
        size="lg"
        fullWidth
        value={what}
        aria-label={texts.what}
        data={MOVED.map((one) => ({ value: one, label: texts.moved[one] }))}
        onChange={setWhat}
      />
      <ArrowPad
        name="channel"
        label={texts.moved[what]}
        onMove={(right, down) => {
          const place = largePlace();
          if (place === null) return;
          const shift = plus(times(rightOf(place), right * STEP_MM), times(downOf(place), down * STEP_MM));
          put(shiftChannel(draft, what, shift));
        }}
      />
      <Button
        size="lg"
        variant="default"
        fullWidth
        data-testid="place-at-cross"
        onClick={() => {
          put(placeChannel(draft, what, look.cursor));
        }}
      >
        {texts.atCross[what]}
      </Button>
      <Stepper
        name="turn"
        label={texts.turn}
        value={`${texts.transverse} ${formatNumber(transverseDeg, 1)}° · ${texts.sagittal} ${formatNumber(sagittalDeg, 1)}°`}
        onStep={(direction) => {
          const place = largePlace();
          if (place !== null) put(rotateChannel(draft, normalOf(place), direction));
        }}
      />
      <Stepper
        name="reach"
        label={texts.length}
        value={`${formatNumber(lengthMm(draft), 1)} mm`}
        onStep={(direction) => {
          put(extendChannel(draft, direction));
        }}
      />
      <Stepper
        name="bore"
        label={texts.diameter}
        value={`${formatNumber(draft.diameterMm, 1)} mm`}
        onStep={(direction) => {
          const wanted = draft.diameterMm + direction * STEP_MM;
          put({ ...draft, diameterMm: Math.min(MAX_DIAMETER_MM, Math.max(MIN_DIAMETER_MM, wanted)) });
        }}
      />
      <StepActions>
        <Button
          size="xl"
          variant="default"
          data-testid="discard-channel"
          onClick={() => {
            setDraft(null);
          }}
        >
          {texts.discard}
        </Button>
        <Button size="xl" disabled={busy || isUnchanged} data-testid="keep-channel" onClick={keep}>
          {texts.keep}
        </Button>
      </StepActions>
    </section>
  );
}
