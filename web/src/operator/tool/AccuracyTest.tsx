import { Button } from "@mantine/core";
import { useState, type ReactNode } from "react";
import {
  deleteCertificatesCollection,
  deleteCertificatesCollectionCapturesLast,
  getCertificatesCollection,
  postCertificatesCollectionCaptures,
  postCertificatesCollectionConclusion,
  type AccuracyTestMessage,
} from "../../api";
import { formatNumber } from "../../live/rounding";
import { Rejection } from "../../rest/client";
import { QueryStatus } from "../../rest/QueryStatus";
import { RejectionNote } from "../../rest/RejectionNote";
import { useAction } from "../../rest/useAction";
import { useQuery } from "../../rest/useQuery";
import type { CertificateTexts } from "../../texts/certificate/en";
import { interpolate } from "../../texts/interpolate";
import { useTexts } from "../../texts/TextsContext";
import { ConfirmButton } from "../parts/ConfirmButton";
import { useMaker } from "../parts/useMaker";
import { accuracyText, placementText } from "./accuracyText";
import { PlatePicture } from "./PlatePicture";

const ASK_EVERY_MS = 400;
const VALID_DAYS = 90;

/** A guided accuracy test: what to do now, one button for it, and the result. */
export function AccuracyTest({ onOver }: { onOver: () => void }): ReactNode {
  const texts = useTexts().certificate.guided;
  const madeBy = useMaker();
  const doing = useAction();
  const [ended, setEnded] = useState(false);
  const query = useQuery((signal) => getCertificatesCollection({ signal }), { everyMs: ASK_EVERY_MS });
  const { data, refetch } = query;
  const act = (action: () => Promise<unknown>, after: () => void): void => {
    void doing
      .run(async () => {
        await action();
      })
      .then((done) => {
        if (done) after();
      });
  };
  const over = (): void => {
    setEnded(true);
    onOver();
  };
  if (ended) return null;
  if (data === null) return <QueryStatus query={query} />;
  const { due, capture, problems } = data;
  const isLooking = capture?.state === "looking";
  const isSound = due === null && problems.length === 0 && data.error_95_mm !== null;
  const placement = placementText(data, texts);
  return (
    <div className="stack" data-testid="accuracy-test">
      <h4>{interpolate(texts.doing, { tool: data.tool })}</h4>
      {placement !== null && <p>{placement}</p>}
      <p className={isSound ? "good" : undefined} role="status" data-testid="accuracy-now">
        <strong>{accuracyText(data, texts)}</strong>
      </p>
      {problems.map((one) => (
        <RejectionNote key={one.code + one.message} rejection={new Rejection(one)} />
      ))}
      {capture?.state === "rejected" && capture.problem !== null && (
        <RejectionNote rejection={new Rejection(capture.problem)} />
      )}
      <PlatePicture test={data} texts={texts} />
      <div className="row">
        {due === null ? (
          <Button
            size="xl"
            disabled={!isSound}
            loading={doing.busy}
            data-testid="accuracy-issue"
            onClick={() => {
              act(
                () =>
                  postCertificatesCollectionConclusion({ body: { made_by: madeBy, valid_days: VALID_DAYS } }),
                over,
              );
            }}
          >
            {texts.issue}
          </Button>
        ) : (
          <Button
            size="xl"
            loading={doing.busy || isLooking}
            data-testid="accuracy-capture"
            onClick={() => {
              act(() => postCertificatesCollectionCaptures({ body: due }), refetch);
            }}
          >
            {texts.capture}
          </Button>
        )}
        <ConfirmButton
          confirmLabel={texts.discardSure}
          testId="accuracy-discard"
          onConfirm={() => {
            act(() => deleteCertificatesCollectionCapturesLast(), refetch);
          }}
        >
          {texts.discard}
        </ConfirmButton>
        <ConfirmButton
          confirmLabel={texts.endSure}
          testId="accuracy-end"
          onConfirm={() => {
            act(() => deleteCertificatesCollection(), over);
          }}
        >
          {texts.end}
        </ConfirmButton>
      </div>
      <Progress test={data} texts={texts} />
      <RejectionNote rejection={doing.rejection} />
    </div>
  );
}

function Progress({
  test,
  texts,
}: {
  test: AccuracyTestMessage;
  texts: CertificateTexts["guided"];
}): ReactNode {
  const { taken, planned, last } = test;
  return (
    <>
      <p data-testid="accuracy-progress">{interpolate(texts.progress, { taken, planned })}</p>
      {last !== null && (
        <p className="soft">
          {interpolate(texts.last, {
            divot: last.divot,
            mm: formatNumber(last.jitter_mm, 2),
            deg: formatNumber(last.jitter_deg, 2),
            images: last.images,
          })}
        </p>
      )}
    </>
  );
}
