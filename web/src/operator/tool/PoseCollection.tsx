import { Button } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { deleteToolsCollection, getToolsCollection, postToolsCollectionConclusion } from "../../api";
import { Rejection } from "../../rest/client";
import { RejectionNote } from "../../rest/RejectionNote";
import { QueryStatus } from "../../rest/QueryStatus";
import { useQuery } from "../../rest/useQuery";
import { useAction } from "../../rest/useAction";
import { useTexts } from "../../texts/TextsContext";
import { StepActions } from "../StepActions";
import { Card } from "../parts/Card";
import { interpolate } from "../../texts/interpolate";
import { ConfirmButton } from "../parts/ConfirmButton";
import { useMaker } from "../parts/useMaker";
import { PoseCollectionMeasures, UnusedImages } from "./PoseCollectionMeasures";
import { toolRecordFrom, type KnownTool, type ToolGate } from "./toolRecord";
import { isShape, Shape, type ShapeMm } from "./Shape";

const ASK_EVERY_MS = 400;

interface PoseCollectionProps {
  tools: readonly KnownTool[];
  gate: ToolGate;
  /** Called with the name of the saved tool; null if nothing was saved. */
  onOver: (stored: string | null) => void;
}

/** Collected poses: progress, missing conditions, and preliminary result. */
export function PoseCollection({ tools, gate, onOver }: PoseCollectionProps): ReactNode {
  const texts = useTexts().tool;
  const madeBy = useMaker();
  const doing = useAction();
  const [shape, setShape] = useState<ShapeMm>({ diameterMm: "", lengthMm: "" });
  const query = useQuery((signal) => getToolsCollection({ signal }), {
    everyMs: ASK_EVERY_MS,
  });
  const { data } = query;
  const end = (): void => {
    void doing
      .run(async () => {
        await deleteToolsCollection();
      })
      .then(() => {
        onOver(null);
      });
  };
  if (data === null) return <QueryStatus query={query} />;
  const known = tools.find((tool) => tool.name === data.tool) ?? null;
  const before = known?.calibration == null ? null : toolRecordFrom(known.calibration.content);
  const needsShape = data.purpose === "pivot" && (before?.radiusMm ?? known?.radius_mm ?? null) === null;
  const given = isShape(shape);
  const enough = data.missing.length === 0;
  const keep = (): void => {
    const size = needsShape && given ? { radius_mm: given.diameterMm / 2, length_mm: given.lengthMm } : {};
    void doing
      .run(async () => {
        await postToolsCollectionConclusion({ body: { made_by: madeBy, ...size } });
      })
      .then((done) => {
        if (done) onOver(data.tool);
      });
  };
  return (
    <Card title={`${texts.doing[data.purpose]}: ${data.tool}`} testId="gathering">
      <p className="card-lead">{texts.how[data.purpose]}</p>
      <p className="newest" data-taking={data.newest} role="status">
        {data.running ? texts.takings[data.newest] : texts.ended}
      </p>
      <RejectionNote rejection={data.problem === null ? null : new Rejection(data.problem)} />
      <PoseCollectionMeasures collection={data} gate={gate} />
      <ul className="missing" aria-label={texts.missing} data-testid="missing" data-enough={enough}>
        {data.missing.map((one) => (
          <li key={one.need}>
            {interpolate(texts.needs[one.need], {
              there: Math.floor(one.there),
              wanted: Math.ceil(one.wanted),
            })}
          </li>
        ))}
        {enough && <li className="good">✓ {texts.enough}</li>}
      </ul>
      {needsShape && <Shape shape={shape} onChange={setShape} />}
      <StepActions>
        <ConfirmButton confirmLabel={texts.throwAwaySure} onConfirm={end} testId="throw-away">
          {texts.throwAway}
        </ConfirmButton>
        <Button
          size="xl"
          variant={enough ? "filled" : "default"}
          disabled={data.outcome === null || (needsShape && given === null)}
          loading={doing.busy}
          data-testid="keep"
          onClick={keep}
        >
          {texts.keep[data.purpose]}
        </Button>
      </StepActions>
      {needsShape && given === null && <p className="soft">{texts.shapeFirst}</p>}
      <UnusedImages collection={data} />
      <RejectionNote rejection={doing.rejection} />
    </Card>
  );
}
