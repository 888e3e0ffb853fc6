import { NumberInput } from "@mantine/core";
import { useEffect, useRef, useState, type ReactNode } from "react";
import { useProcedure } from "../../app/procedure";
import { formatNumber } from "../../live/rounding";
import { QueryStatus } from "../../rest/QueryStatus";
import { useAction } from "../../rest/useAction";
import { useQuery } from "../../rest/useQuery";
import {
  type ChannelStateMessage,
  deleteNavigationPlacementsByDocumentId,
  getNavigationPlacements,
  type PlacementsMessage,
  postNavigationPlacements,
} from "../../api";
import { useTexts } from "../../texts/TextsContext";
import { interpolate } from "../../texts/interpolate";
import { StepActions } from "../StepActions";
import { ConfirmButton } from "../parts/ConfirmButton";
import { formatTime } from "../parts/format";
import { bringIntoView } from "../parts/useIntoView";
import { ConfirmOrCancelButton } from "../registration/ConfirmOrCancelButton";
import { RegistrationRejection } from "../registration/RegistrationRejection";
import { useMadeBy } from "../registration/useMadeBy";
import { useSides } from "../registration/useSides";
import { placedFigures } from "./placedFigures";

// The active channel, which the button names, is also switched in the card beside and on other tablets.
const ASK_EVERY_MS = 1000;

type Channel = ChannelStateMessage;
type Placements = PlacementsMessage;

/** The planned channels with their state; "placed here" stores where the drill is now. */
export function PlacedScrews(): ReactNode {
  const procedure = useProcedure();
  const plan = procedure.data?.steps.find((one) => one.step === "plan");
  const isPlanned = plan !== undefined && plan.document_id !== null;
  if (!isPlanned) return null;
  // Plan and registration change the list.
  const key = procedure.data?.steps.map((one) => `${one.state} ${one.document_id ?? ""}`).join(" ") ?? "";
  return <Channels stepsKey={key} />;
}

function Channels({ stepsKey }: { stepsKey: string }): ReactNode {
  const texts = useTexts().navigate.screws;
  const madeBy = useMadeBy();
  const query = useQuery((signal) => getNavigationPlacements({ signal }), {
    key: stepsKey,
    everyMs: ASK_EVERY_MS,
  });
  const acting = useAction();
  const { rejection } = acting;
  // The button is always in sight, the list is below the picture.
  const rejected = useRef<HTMLDivElement>(null);
  useEffect(() => {
    if (rejection !== null && rejected.current !== null) bringIntoView(rejected.current);
  }, [rejection]);
  const act = (request: () => Promise<Placements>): void => {
    void acting
      .run(async () => {
        await request();
      })
      .then(query.refetch);
  };
  if (query.data === null) return <QueryStatus query={query} Note={RegistrationRejection} />;
  const active = query.data.channels.find((one) => one.is_active);
  return (
    <section className="card" data-testid="placed-screws">
      <h3>{texts.title}</h3>
      <ul className="placed-screws">
        {query.data.channels.map((one) => (
          <ChannelRow
            key={`${one.vertebra} ${one.side}`}
            channel={one}
            busy={acting.busy}
            onWithdraw={(documentId) => {
              const options = { path: { document_id: documentId }, query: { made_by: madeBy } };
              act(() => deleteNavigationPlacementsByDocumentId(options));
            }}
          />
        ))}
      </ul>
      {active !== undefined && (
        <PlaceHere
          // Another channel begins with its own planned size.
          key={`${active.vertebra} ${active.side} ${active.screw === null ? "" : sizeText(active.screw)}`}
          channel={active}
          busy={acting.busy}
          onPlace={(size) => {
            const { vertebra, side } = active;
            act(() => postNavigationPlacements({ body: { made_by: madeBy, vertebra, side, ...size } }));
          }}
        />
      )}
      <div ref={rejected}>
        <RegistrationRejection rejection={rejection} />
      </div>
    </section>
  );
}

function ChannelRow({
  channel,
  busy,
  onWithdraw,
}: {
  channel: Channel;
  busy: boolean;
  onWithdraw: (documentId: string) => void;
}): ReactNode {
  const all = useTexts();
  const texts = all.navigate.screws;
  const sideName = useSides();
  const { placement } = channel;
  const screw = placement?.screw ?? channel.screw;
  return (
    <li data-testid={`screw-${channel.vertebra}-${channel.side}`} data-placed={placement !== null}>
      <p className="row">
        <strong>
          {channel.vertebra} {sideName(channel.side)}
        </strong>
        {screw !== null && (
          <span>
            {sizeText(screw)} mm
            {placement !== null && channel.screw !== null && sizeText(channel.screw) !== sizeText(screw)
              ? ` (${texts.planned}: ${sizeText(channel.screw)} mm)`
              : ""}
          </span>
        )}
        <span>
          {placement !== null
            ? `✓ ${texts.placed}`
            : channel.is_active
              ? `● ${texts.active}`
              : channel.is_registered
                ? `○ ${texts.registered}`
                : `○ ${texts.planned}`}
        </span>
      </p>
      {placement !== null && (
        <>
          <p>{placedFigures(placement, all)}</p>
          {placement.out_of_date !== null && <p className="warning">▲ {texts.outOfDate}</p>}
          <div className="row">
            <span className="quiet">
              {formatTime(placement.placed_at, all.language)} · {placement.placed_by}
            </span>
            <ConfirmButton
              confirmLabel={texts.withdrawSure}
              loading={busy}
              testId={`withdraw-${channel.vertebra}-${channel.side}`}
              onConfirm={() => {
                onWithdraw(placement.document_id);
              }}
            >
              {texts.withdraw}
            </ConfirmButton>
          </div>
        </>
      )}
    </li>
  );
}

function sizeText({ diameter_mm, length_mm }: Size): string {
  return `${formatNumber(diameter_mm)} × ${formatNumber(length_mm, 0)}`;
}

interface Size {
  diameter_mm: number;
  length_mm: number;
}

function PlaceHere({
  channel,
  busy,
  onPlace,
}: {
  channel: Channel;
  busy: boolean;
  onPlace: (size: Size | null) => void;
}): ReactNode {
  const texts = useTexts().navigate.screws;
  const sideName = useSides();
  // The size that is placed; as planned until another one is entered.
  const [diameter, setDiameter] = useState<number | string>(channel.screw?.diameter_mm ?? "");
  const [length, setLength] = useState<number | string>(channel.screw?.length_mm ?? "");
  const size =
    typeof diameter === "number" && typeof length === "number"
      ? { diameter_mm: diameter, length_mm: length }
      : null;
  const name = `${channel.vertebra} ${sideName(channel.side)}`;
  return (
    <div className="stack">
      <div className="row">
        <NumberInput
          hideControls
          inputMode="decimal"
          size="lg"
          label={texts.diameter}
          min={1}
          max={20}
          step={0.5}
          value={diameter}
          onChange={setDiameter}
          data-testid="placed-diameter"
        />
        <NumberInput
          hideControls
          inputMode="decimal"
          size="lg"
          label={texts.length}
          min={5}
          max={200}
          step={5}
          value={length}
          onChange={setLength}
          data-testid="placed-length"
        />
      </div>
      <StepActions>
        <ConfirmOrCancelButton
          // The first placement can be withdrawn; another one replaces what is stored.
          needsConfirmation={channel.placement !== null}
          confirmLabel={interpolate(texts.replaceSure, { channel: name })}
          busy={busy}
          disabled={size === null}
          testId="place-here"
          onConfirm={() => {
            onPlace(size);
          }}
        >
          {interpolate(texts.placeHere, { channel: name })}
        </ConfirmOrCancelButton>
      </StepActions>
      <p className="quiet">{texts.hint}</p>
    </div>
  );
}
