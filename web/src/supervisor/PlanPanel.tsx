import type { ReactNode } from "react";
import { formatNumber } from "../live/rounding";
import { getPlan } from "../api";
import { throughHub } from "../hub/openedTheatre";
import { QueryStatus } from "../rest/QueryStatus";
import { useQuery } from "../rest/useQuery";
import type { Signable } from "../room/messages";
import { useTexts } from "../texts/TextsContext";
import { vertebraeOf, type ChannelShown, type VertebraShown } from "./planRecords";
import { SignBox } from "./SignBox";
import { pluralize } from "../texts/pluralize";

/** The plan in text and pictures, with its co-signature. */
export function PlanPanel({ signable }: { signable: Signable }): ReactNode {
  const texts = useTexts().supervisor;
  const key = signable.document_id ?? "";
  const query = useQuery((signal) => (key === "" ? Promise.resolve(null) : getPlan({ signal })), { key });
  if (key === "") return <p className="soft">{texts.plan.none}</p>;
  const { data } = query;
  if (data === null) return <QueryStatus query={query} />;
  const active = data.active_channel;
  return (
    <>
      <p className="plan-active">
        {active === null ? (
          texts.plan.noneDrilled
        ) : (
          <>
            {texts.plan.drilled}:{" "}
            <b>
              {active.vertebra} {texts.plan.side[active.side]}
            </b>
          </>
        )}
      </p>
      {vertebraeOf(data.plan).map((vertebra) => (
        <Vertebra key={vertebra.name} vertebra={vertebra} version={data.heading.id} />
      ))}
      {/* The key is the version, so that a new version mounts a new box and must be read before it is signed. */}
      {data.heading.id === signable.document_id && <SignBox signable={signable} />}
    </>
  );
}

function Vertebra({ vertebra, version }: { vertebra: VertebraShown; version: string }): ReactNode {
  const { supervisor, language } = useTexts();
  const texts = supervisor.plan;
  const picture = throughHub(
    `/api/plan/vertebrae/${encodeURIComponent(vertebra.name)}/reference.png?version=${version}`,
  );
  return (
    <article className="vertebra">
      <div>
        <h3>
          {vertebra.name} <small>{pluralize(texts.landmarks, vertebra.landmarks, language)}</small>
        </h3>
        {vertebra.channels.map((channel) => (
          <Channel key={channel.side} channel={channel} />
        ))}
      </div>
      {vertebra.hasReference ? (
        <img src={picture} alt={`${texts.picture}, ${vertebra.name}`} loading="lazy" />
      ) : (
        <p className="soft">{texts.noPicture}</p>
      )}
    </article>
  );
}

function Channel({ channel }: { channel: ChannelShown }): ReactNode {
  const texts = useTexts().supervisor.plan;
  const { screw } = channel;
  return (
    <dl className="channel" data-side={channel.side}>
      <dt>
        {texts.channel} {texts.side[channel.side]}
      </dt>
      <dd>
        {channel.diameterMm !== null && `Ø ${formatNumber(channel.diameterMm)} mm`}
        {channel.lengthMm !== null && ` × ${formatNumber(channel.lengthMm)} mm`}
        {` · ${channel.byHand ? texts.byHand : texts.measured}`}
      </dd>
      <dt>{texts.screw}</dt>
      <dd>
        {screw === null
          ? texts.noScrew
          : `Ø ${formatNumber(screw.diameterMm)} × ${formatNumber(screw.lengthMm, 0)} mm`}
      </dd>
      {screw?.minMm != null && (
        <>
          <dt>{texts.clearance}</dt>
          <dd data-bad={screw.minMm < 0}>
            {screw.minMm < 0 && <span aria-hidden="true">▲ </span>}
            {formatNumber(screw.minMm)} mm {screw.minWall !== null && texts.wall[screw.minWall]}
            {screw.grade !== "" && ` · ${texts.grade} ${screw.grade}`}
          </dd>
        </>
      )}
      {screw?.meanHu != null && (
        <>
          <dt>{texts.density}</dt>
          <dd>{formatNumber(screw.meanHu, 0)} HU</dd>
        </>
      )}
    </dl>
  );
}
