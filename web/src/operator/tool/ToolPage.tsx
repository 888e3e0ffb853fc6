import { useState, type ReactNode } from "react";
import { VideoPane } from "../../panes/VideoPane";
import { answered, server } from "../../rest/client";
import { RejectionNote } from "../../rest/RejectionNote";
import { Unanswered } from "../../rest/Unanswered";
import { useAsked } from "../../rest/useAsked";
import { useDo } from "../../rest/useDo";
import { useTexts } from "../../texts/TextsContext";
import { useDocuments } from "../parts/useDocuments";
import { useGates } from "../parts/useGates";
import { useProcedure } from "../../app/procedure";
import { Gathering } from "./Gathering";
import type { Purpose } from "./kept";
import { NewTool } from "./NewTool";
import { ToolCard } from "./ToolCard";

const ASK_EVERY_MS = 2000;

/** Tools: the tip by pivoting, the axis by spinning, the tip checked; each with its live progress. */
export function ToolPage(): ReactNode {
  const texts = useTexts().tool;
  const procedure = useProcedure();
  const gates = useGates();
  const documents = useDocuments();
  const asked = useAsked((signal) => answered(server.GET("/api/tools", { signal })), {
    everyMs: ASK_EVERY_MS,
  });
  const { data, again } = asked;
  const beginning = useDo();
  const [keptHere, setKeptHere] = useState<string | null>(null);
  const begin = (tool: string, purpose: Purpose, marker: string | null): void => {
    void beginning
      .run(async () => {
        await answered(server.POST("/api/tools/collection", { body: { tool, purpose, marker } }));
      })
      .then(again);
  };
  const over = (kept: string | null): void => {
    setKeptHere(kept);
    again();
    procedure.again();
  };
  if (data === null) return <Unanswered asked={asked} />;
  if (gates.data === null) return <Unanswered asked={gates} />;
  if (procedure.data === null && procedure.rejection === null) return <Unanswered asked={procedure} />;
  const gate = gates.data.tool_calibration;
  if (procedure.data?.case_id === null) return <p className="card-lead">{texts.noCase}</p>;
  return (
    <div className="beside">
      <div className="cards">
        <RejectionNote rejection={beginning.rejection} />
        {data.collecting ? (
          <Gathering tools={data.tools} gate={gate} onOver={over} />
        ) : (
          <>
            {data.tools.map((tool) => (
              <ToolCard
                key={tool.name}
                tool={tool}
                gate={gate}
                documents={documents}
                busy={beginning.busy}
                fresh={keptHere === tool.name ? tool.name : null}
                onBegin={begin}
              />
            ))}
            <NewTool
              first={data.tools.length === 0}
              taken={data.tools.map((tool) => tool.name)}
              busy={beginning.busy}
              onBegin={begin}
            />
          </>
        )}
      </div>
      <VideoPane />
    </div>
  );
}
