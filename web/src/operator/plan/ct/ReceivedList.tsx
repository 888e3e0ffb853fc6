import { Alert, Button } from "@mantine/core";
import type { ReactNode } from "react";
import {
  deleteCtReceivedBySeriesId,
  getCtReceived,
  postCtReceivedBySeriesId,
  type ReceivedSeriesMessage,
  type UploadMessage,
} from "../../../api";
import { formatNumber } from "../../../live/rounding";
import { RejectionNote, sentence } from "../../../rest/RejectionNote";
import { useAction } from "../../../rest/useAction";
import { useQuery } from "../../../rest/useQuery";
import { pluralize } from "../../../texts/pluralize";
import { useTexts } from "../../../texts/TextsContext";
import { useMadeBy } from "../state/madeBy";

const REFETCH_MS = 3000;

interface ReceivedListProps {
  onBegun: (begun: UploadMessage) => void;
}

/** Series that a scanner or an archive sent; nothing where none can be received. */
export function ReceivedList({ onBegun }: ReceivedListProps): ReactNode {
  const texts = useTexts().plan.ct.received;
  const madeBy = useMadeBy();
  const received = useQuery((signal) => getCtReceived({ signal }), { everyMs: REFETCH_MS });
  const action = useAction();
  if (received.data === null || received.data.address === "") return null;
  const { address, series, remark } = received.data;

  const take = (one: ReceivedSeriesMessage): void => {
    void action.run(async () => {
      const begun = await postCtReceivedBySeriesId({
        path: { series_id: one.id },
        query: { made_by: madeBy },
      });
      onBegun(begun);
    });
  };
  const discard = (one: ReceivedSeriesMessage): void => {
    void action.run(async () => {
      await deleteCtReceivedBySeriesId({ path: { series_id: one.id } });
      received.refetch();
    });
  };

  return (
    <section aria-label={texts.title} data-testid="received-ct">
      <h3>{texts.title}</h3>
      <p>
        {series.length === 0 && texts.none} {texts.address} <code>{address}</code>
      </p>
      <RejectionNote rejection={action.rejection} />
      <ul className="series">
        {series.map((one) => (
          <ReceivedRow
            key={one.id}
            one={one}
            busy={action.busy}
            onTake={() => {
              take(one);
            }}
            onDiscard={() => {
              discard(one);
            }}
          />
        ))}
      </ul>
      {remark !== null && (
        <Alert className="warning" title={texts.rejected}>
          {sentence(remark.message)}. {remark.remedy} <code>{remark.code}</code>
        </Alert>
      )}
    </section>
  );
}

interface ReceivedRowProps {
  one: ReceivedSeriesMessage;
  busy: boolean;
  onTake: () => void;
  onDiscard: () => void;
}

function ReceivedRow({ one, busy, onTake, onDiscard }: ReceivedRowProps): ReactNode {
  const all = useTexts();
  const texts = all.plan.ct;
  const problem = one.problem?.message ?? one.unusable;
  return (
    <li data-problem={problem !== "" || !one.complete || undefined}>
      <div>
        <strong>
          {one.number > 0 && `${one.number} · `}
          {one.words || texts.series.unnamed} {one.modality}
        </strong>
        <p>
          {pluralize(texts.series.images, one.files, all.language)}
          {one.complete && one.problem === null && (
            <>
              {" · "}
              {one.size_wh_px.join(" × ")} · {formatNumber(one.thickness_mm, 2)} mm {texts.series.thick}
              {one.kernel !== "" && ` · ${one.kernel}`}
            </>
          )}
          {" · "}
          {pluralize(texts.received.minutes, Math.floor(one.age_s / 60), all.language)}
        </p>
        {!one.complete && <p className="warning">{texts.received.incomplete}</p>}
        {problem !== "" && <p className="warning">{problem}</p>}
      </div>
      <Button size="lg" disabled={busy || !one.complete} onClick={onTake}>
        {texts.received.take}
      </Button>
      <Button size="lg" variant="default" disabled={busy} onClick={onDiscard}>
        {texts.received.discard}
      </Button>
    </li>
  );
}
