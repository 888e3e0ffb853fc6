import { Button } from "@mantine/core";
import { useEffect, useEffectEvent, useState, type ReactNode } from "react";
import { formatBytes } from "../../operator/parts/format";
import {
  getRecordingsByNameExports,
  postRecordingsByNameCut,
  postRecordingsByNameSequence,
  postRecordingsByNameTables,
  postRecordingsByNameVideo,
} from "../../api";
import { JobProgress } from "../../rest/JobProgress";
import { RejectionNote } from "../../rest/RejectionNote";
import { useAction } from "../../rest/useAction";
import { isOver, useJob, type Job } from "../../rest/useJob";
import { useQuery } from "../../rest/useQuery";
import { interpolate } from "../../texts/interpolate";
import { useTexts } from "../../texts/TextsContext";
import { clockTenths } from "../recordingText";
import { exportOf, exportText, type RecordingExport } from "./recordingExport";
import type { Span } from "./span";

interface ExportsProps {
  name: string;
  atS: number;
  durationS: number;
  piece: Span | null;
  onPiece: (piece: Span) => void;
}

/** Saves a section of the recording, or all of it as video or tables, and lists exports for download. */
export function Exports({ name, atS, durationS, piece, onPiece }: ExportsProps): ReactNode {
  const texts = useTexts();
  const own = texts.recording.review.exports;
  const [made, setMade] = useState<RecordingExport | null>(null);
  const doing = useAction();
  const path = { name };
  const { data, rejection, refetch } = useQuery((signal) => getRecordingsByNameExports({ path, signal }), {
    key: name,
  });
  const { follow, ...followed } = useJob((job) => {
    setMade(exportOf(job));
    refetch();
  });
  // A job continues without viewers.
  const [found, setFound] = useState<Job | null>(null);
  if (found === null && data?.job != null) setFound(data.job);
  const onFound = useEffectEvent((job: Job) => {
    if (followed.job === null) follow(job);
  });
  useEffect(() => {
    if (found !== null) onFound(found);
  }, [found]);
  const isBusy = doing.busy || (followed.job !== null && !isOver(followed.job));
  const start = (ask: () => Promise<Job>) => () => {
    setMade(null);
    void doing.run(async () => {
      follow(await ask());
    });
  };
  const section = { from_s: piece?.fromS ?? 0, to_s: piece?.toS ?? durationS };
  const cut = start(() => postRecordingsByNameCut({ path, body: section }));
  const sequence = start(() => postRecordingsByNameSequence({ path, body: section }));
  const tables = start(() => postRecordingsByNameTables({ path }));
  const film = start(() =>
    postRecordingsByNameVideo({ path, body: { language: texts.language === "de" ? "de" : "en" } }),
  );
  return (
    <section className="review-exports" aria-label={own.title}>
      <h4>{own.title}</h4>
      <p className="soft" data-testid="review-piece-text">
        {piece === null
          ? own.whole
          : interpolate(own.piece, { from: clockTenths(piece.fromS), to: clockTenths(piece.toS) })}
      </p>
      <div className="row">
        <Button
          size="lg"
          variant="default"
          data-testid="review-piece-begin"
          onClick={() => {
            onPiece({ fromS: atS, toS: Math.max(atS, piece?.toS ?? durationS) });
          }}
        >
          {own.beginHere}
        </Button>
        <Button
          size="lg"
          variant="default"
          data-testid="review-piece-end"
          onClick={() => {
            onPiece({ fromS: Math.min(atS, piece?.fromS ?? 0), toS: atS });
          }}
        >
          {own.endHere}
        </Button>
        <Button size="lg" disabled={isBusy || piece === null} data-testid="review-piece-save" onClick={cut}>
          {own.savePiece}
        </Button>
        <Button size="lg" disabled={isBusy} data-testid="review-video-save" onClick={film}>
          {own.saveVideo}
        </Button>
        <Button
          size="lg"
          variant="default"
          disabled={isBusy || piece === null}
          data-testid="review-sequence-save"
          onClick={sequence}
        >
          {own.saveSequence}
        </Button>
        <Button
          size="lg"
          variant="default"
          disabled={isBusy}
          data-testid="review-tables-save"
          onClick={tables}
        >
          {own.saveTables}
        </Button>
      </div>
      <RejectionNote rejection={doing.rejection ?? rejection} />
      <JobProgress followed={{ follow, ...followed }} />
      {(data?.files ?? []).map((one) => (
        <div className="row" role="status" key={one.file}>
          <Button
            size="lg"
            variant="default"
            component="a"
            href={`/api/recordings/${name}/exports/${one.file}`}
            download={one.file}
            data-testid="review-export-download"
          >
            {interpolate(own.download, { file: one.file })}
          </Button>
          <p>{one.file === made?.file ? exportText(made, texts) : formatBytes(one.size_bytes)}</p>
        </div>
      ))}
    </section>
  );
}
