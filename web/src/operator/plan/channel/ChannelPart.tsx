import { Button } from "@mantine/core";
import type { ReactNode } from "react";
import { deletePlanVertebraeByNameChannelsBySide, putPlanVertebraeByNameChannelsBySide } from "../../../api";
import { useTexts } from "../../../texts/TextsContext";
import { SetupCheckNote } from "../../SetupCheckNote";
import { SideChooser } from "../pedicle/SideChooser";
import { StepActions } from "../../StepActions";
import { VertebraChooser } from "../pedicle/VertebraChooser";
import { useSlices } from "../slices/SlicesContext";
import { plus } from "../slices/vectors";
import { usePlanning } from "../state/PlanContext";
import { channelOf, recordOf } from "../state/shape";
import { useWork } from "../state/WorkContext";
import { ActiveChoice } from "./ActiveChoice";
import { ChannelByHand } from "./ChannelByHand";
import { draftOf } from "./draft";
import { ScrewChoice } from "./ScrewChoice";

/** The channel of a pedicle: automatic or by hand, with its screw, and whether it is active. */
export function ChannelPart(): ReactNode {
  const texts = useTexts().plan.channel;
  const { vertebra, side, change, busy } = usePlanning();
  const { draft, setDraft } = useWork();
  const { look } = useSlices();
  if (vertebra === null) return <p>{texts.noVertebra}</p>;
  const { name } = vertebra;
  const of = `${name} ${side}`;
  const planned = channelOf(vertebra, side);
  const isMeasured = recordOf(vertebra, side) !== null;
  const path = { name, side };
  const layAlongPedicle = (): void => {
    void change((by) => putPlanVertebraeByNameChannelsBySide({ path, body: by })).then((made) => {
      if (made) setDraft(null);
    });
  };
  const remove = (): void => {
    void change((by) => deletePlanVertebraeByNameChannelsBySide({ path, query: by }));
  };
  const moved = draft?.of === of ? draft.channel : null;
  const beginAt = (): void => {
    setDraft({ of, channel: { entry: look.cursor, target: plus(look.cursor, [0, -40, 0]), diameterMm: 6 } });
  };
  return (
    <>
      <VertebraChooser />
      <SideChooser />
      {planned === null && moved === null && (
        <>
          <p>{isMeasured ? texts.none : texts.notMeasured}</p>
          <StepActions>
            <Button
              size="xl"
              disabled={busy || !isMeasured}
              data-testid="lay-channel"
              onClick={layAlongPedicle}
            >
              {texts.lay}
            </Button>
          </StepActions>
          <Button size="lg" fullWidth variant="default" disabled={busy} onClick={beginAt}>
            {texts.byHandHere}
          </Button>
        </>
      )}
      {moved !== null ? (
        <ChannelByHand of={of} draft={moved} planned={planned} />
      ) : (
        planned !== null && (
          <>
            <ActiveChoice vertebra={name} planned={planned} />
            <ScrewChoice key={of} vertebra={name} planned={planned} isMeasured={isMeasured} />
            <SetupCheckNote />
            <div className="buttons">
              <Button
                size="lg"
                variant="default"
                data-testid="move-channel"
                onClick={() => {
                  setDraft({ of, channel: draftOf(planned.channel) });
                }}
              >
                {texts.move}
              </Button>
              {planned.by_hand && isMeasured && (
                <Button size="lg" variant="default" disabled={busy} onClick={layAlongPedicle}>
                  {texts.back}
                </Button>
              )}
              <Button
                size="lg"
                variant="default"
                disabled={busy}
                data-testid="remove-channel"
                onClick={remove}
              >
                {texts.remove}
              </Button>
            </div>
          </>
        )
      )}
    </>
  );
}
