import { Button } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { useProcedure } from "../app/procedure";
import { ConfirmButton } from "../operator/parts/ConfirmButton";
import { formatBytes, formatTime } from "../operator/parts/format";
import { EmptyState } from "../panes/EmptyState";
import { PageLink } from "../rest/PageLink";
import { QueryStatus } from "../rest/QueryStatus";
import { RejectionNote } from "../rest/RejectionNote";
import { useAction } from "../rest/useAction";
import { useQuery } from "../rest/useQuery";
import {
  deleteRecordingsByName,
  getRecordings,
  putRecordingsByNameProtection,
  type RecordingMessage,
} from "../api";
import { interpolate } from "../texts/interpolate";
import { useTexts } from "../texts/TextsContext";
import { clockDuration } from "./recordingText";
import { Review } from "./review/Review";
import { ReviewPair } from "./review/ReviewPair";

type Stored = RecordingMessage;

/** Recordings of the open case and the review of one or two. Users with the right may protect and delete them. */
export function Recordings({ mayChange }: { mayChange: boolean }): ReactNode {
  const texts = useTexts();
  const own = texts.recording.list;
  const { data: procedure } = useProcedure();
  const caseId = procedure?.case_id ?? null;
  // The list changes when a recording begins or ends.
  const running = procedure?.recording?.name ?? "";
  // The list contains a recording only after its first bytes are written.
  const isWritten = (procedure?.recording?.size_bytes ?? 0) > 0;
  const query = useQuery(
    async (signal) => (caseId === null ? null : (await getRecordings({ signal })).recordings),
    { key: `${caseId ?? ""} ${running} ${isWritten}` },
  );
  const [chosen, setChosen] = useState<string | null>(null);
  const [compared, setCompared] = useState<string | null>(null);
  const { data, isLoading } = query;
  if (procedure === null || (data === null && isLoading))
    return <QueryStatus query={{ ...query, rejection: null }} />;
  if (caseId === null)
    return (
      <EmptyState drawing="case" sentence={own.noCase}>
        {mayChange && <PageLink page="case" />}
      </EmptyState>
    );
  if (data === null) return <QueryStatus query={query} />;
  const ended = data.filter((one) => !one.is_running);
  const reviewed = ended.find((one) => one.name === chosen) ?? null;
  const second = ended.find((one) => one.name === compared && one !== reviewed) ?? null;
  const titleOf = (one: Stored): string => interpolate(own.title, { number: data.indexOf(one) + 1 });
  return (
    <div className="recordings" data-testid="recordings">
      {data.length === 0 && <EmptyState drawing="recording" sentence={own.none} />}
      <ul className="recordings-list">
        {data.map((one) => (
          <RecordingRow
            key={one.name}
            recording={one}
            title={titleOf(one)}
            mayChange={mayChange}
            isReviewed={one === reviewed}
            mayCompare={reviewed !== null && one !== reviewed && one !== second}
            onReview={() => {
              setChosen(one.name === chosen ? null : one.name);
              setCompared(null);
            }}
            onCompare={() => {
              setCompared(one.name);
            }}
            onChange={query.refetch}
          />
        ))}
      </ul>
      {reviewed !== null && second === null && (
        <Review key={reviewed.name} name={reviewed.name} mayExport={mayChange} />
      )}
      {reviewed !== null && second !== null && (
        <ReviewPair
          key={`${reviewed.name} ${second.name}`}
          names={[reviewed.name, second.name]}
          titles={[titleOf(reviewed), titleOf(second)]}
          onClose={() => {
            setCompared(null);
          }}
        />
      )}
    </div>
  );
}

interface RecordingRowProps {
  recording: Stored;
  title: string;
  mayChange: boolean;
  isReviewed: boolean;
  /** Whether it can be compared with the reviewed one. */
  mayCompare: boolean;
  onReview: () => void;
  onCompare: () => void;
  onChange: () => void;
}

function RecordingRow(props: RecordingRowProps): ReactNode {
  const { recording, title, mayChange, isReviewed, mayCompare, onReview, onCompare, onChange } = props;
  const texts = useTexts();
  const own = texts.recording.list;
  const doing = useAction();
  const { name, is_protected, is_running, duration_s } = recording;
  const path = { name };
  const protect = async (): Promise<void> => {
    await doing.run(async () => {
      const body = { is_protected: !is_protected };
      await putRecordingsByNameProtection({ path, body });
    });
    onChange();
  };
  const remove = async (): Promise<void> => {
    await doing.run(async () => {
      await deleteRecordingsByName({ path });
    });
    onChange();
  };
  const state = is_running ? own.running : duration_s === null ? own.cut : own.complete;
  return (
    <li className="recordings-row" data-testid="recording" data-name={name} aria-current={isReviewed}>
      <p className="recordings-about">
        <strong>{title}</strong> · {formatTime(recording.began_at, texts.language)}
        <span className="soft">
          {duration_s !== null && `${clockDuration(duration_s)} · `}
          {formatBytes(recording.size_bytes)} · <span data-testid="recording-end">{state}</span>
          {is_protected && ` · ✓ ${own.isProtected}`}
        </span>
      </p>
      {!is_running && (
        <div className="row recordings-buttons">
          <Button
            size="lg"
            variant={isReviewed ? "filled" : "default"}
            data-testid="review-open"
            onClick={onReview}
          >
            {isReviewed ? own.close : own.review}
          </Button>
          {mayCompare && (
            <Button size="lg" variant="default" data-testid="review-compare" onClick={onCompare}>
              {own.compare}
            </Button>
          )}
          <Button
            size="lg"
            variant="default"
            component="a"
            href={`/api/recordings/${name}/file`}
            download={name}
          >
            {own.download}
          </Button>
          {mayChange && (
            <Button
              size="lg"
              variant="default"
              loading={doing.busy}
              data-testid="protect"
              onClick={() => void protect()}
            >
              {is_protected ? own.unprotect : own.protect}
            </Button>
          )}
          {mayChange && !is_protected && (
            <ConfirmButton
              confirmLabel={own.deleteConfirm}
              loading={doing.busy}
              testId="delete"
              onConfirm={() => void remove()}
            >
              {own.delete}
            </ConfirmButton>
          )}
        </div>
      )}
      <RejectionNote rejection={doing.rejection} />
    </li>
  );
}
