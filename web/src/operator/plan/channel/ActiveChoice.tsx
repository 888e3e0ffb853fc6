import { Button } from "@mantine/core";
import type { ReactNode } from "react";
import { formatNumber } from "../../../live/rounding";
import { deletePlanActiveChannel, postPlanActiveChannel } from "../../../api";
import { useTexts } from "../../../texts/TextsContext";
import { StepActions } from "../../StepActions";
import { usePlanning } from "../state/PlanContext";
import type { PlannedChannel } from "../state/shape";
import { anglesOf, draftOf, lengthMm } from "./draft";

/** Origin of the channel, and whether it is the active one. */
export function ActiveChoice({
  vertebra,
  planned,
}: {
  vertebra: string;
  planned: PlannedChannel;
}): ReactNode {
  const texts = useTexts().plan.channel;
  const { plan, change, busy, by } = usePlanning();
  const { side } = planned;
  const active = plan?.active_channel ?? null;
  const isActive = active?.vertebra === vertebra && active.side === side;
  const draft = draftOf(planned.channel);
  const { transverseDeg, sagittalDeg } = anglesOf(draft, side);
  const { made_by } = by;
  const choose = (): void => {
    void change(() =>
      isActive
        ? deletePlanActiveChannel({ query: { made_by } })
        : postPlanActiveChannel({ body: { made_by, vertebra, side } }),
    );
  };
  return (
    <section className="active-choice" data-active={isActive || undefined}>
      <p data-testid="channel-numbers">
        {planned.by_hand ? texts.isByHand : texts.isMeasured} · Ø {formatNumber(draft.diameterMm, 1)} mm ·{" "}
        {formatNumber(lengthMm(draft), 1)} mm · {texts.transverse} {formatNumber(transverseDeg, 1)}° ·{" "}
        {texts.sagittal} {formatNumber(sagittalDeg, 1)}°
      </p>
      {isActive && (
        <p className="is-active" data-testid="is-active">
          ● {texts.isActive}
        </p>
      )}
      <StepActions>
        <Button
          size="xl"
          disabled={busy}
          variant={isActive ? "default" : "filled"}
          data-testid="activate"
          onClick={choose}
        >
          {isActive ? texts.deactivate : texts.activate}
        </Button>
      </StepActions>
    </section>
  );
}
