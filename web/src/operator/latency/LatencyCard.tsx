import { Button } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { postLatencyMeasurement } from "../../api";
import { Rejection } from "../../rest/client";
import { RejectionNote } from "../../rest/RejectionNote";
import { useLive } from "../../live/LiveContext";
import { useAction } from "../../rest/useAction";
import { useLatency } from "../../rest/useLatency";
import { otherImagesText } from "../../panes/latencyText";
import { useTexts } from "../../texts/TextsContext";
import { Card } from "../parts/Card";
import { LatencyReport } from "./LatencyReport";
import { LatencyScreen } from "./LatencyScreen";
import type { Plan, Result } from "./measure";

/** Latency from light to page, measured with this screen and the camera in front of it. */
export function LatencyCard(): ReactNode {
  const texts = useTexts().latency;
  const { data, refetch } = useLatency();
  // A simulated camera sees no screen.
  const isSimulated = useLive().view.newest?.source.name === "rehearsal";
  const beginning = useAction();
  const [plan, setPlan] = useState<Plan | null>(null);
  const [rejection, setRejection] = useState<Rejection | null>(null);
  const [madeHere, setMadeHere] = useState<string | null>(null);
  const begin = (): void => {
    setRejection(null);
    void beginning.run(async () => {
      setPlan(await postLatencyMeasurement({ body: { codes: CODES } }));
    });
  };
  const onOver = (result: Result | null, rejected: Rejection | null): void => {
    setPlan(null);
    setRejection(rejected);
    if (result === null) return;
    setMadeHere(result.at);
    refetch();
  };
  const result = data?.result ?? null;
  return (
    <Card title={texts.title} testId="latency" fresh={result?.at === madeHere ? madeHere : null}>
      <p>{texts.lead}</p>
      {result === null ? (
        data !== null && <p className="soft">{isSimulated ? texts.simulated : texts.never}</p>
      ) : (
        <LatencyReport result={result} />
      )}
      {result !== null && data?.applies === false && (
        <p role="status" data-testid="latency-other-images">
          {otherImagesText(result, texts)}
        </p>
      )}
      <div>
        <Button
          size="lg"
          variant="default"
          loading={beginning.busy}
          disabled={isSimulated}
          data-testid="latency-begin"
          onClick={begin}
        >
          {result === null ? texts.begin : texts.beginAgain}
        </Button>
      </div>
      <RejectionNote rejection={rejection ?? beginning.rejection} />
      {plan !== null && <LatencyScreen plan={plan} onOver={onOver} />}
    </Card>
  );
}

/** Some 20 s at 30 images/s. */
const CODES = 160;
