import { useState, type ReactNode } from "react";
import { EmptyState } from "../../panes/EmptyState";
import { VideoPane } from "../../panes/VideoPane";
import { getTools, postToolsCollection } from "../../api";
import { PageLink } from "../../rest/PageLink";
import { RejectionNote } from "../../rest/RejectionNote";
import { QueryStatus } from "../../rest/QueryStatus";
import { useQuery } from "../../rest/useQuery";
import { useAction } from "../../rest/useAction";
import { useTexts } from "../../texts/TextsContext";
import { useDocuments } from "../parts/useDocuments";
import { useGates } from "../parts/useGates";
import { useProcedure } from "../../app/procedure";
import { RehearsalStrip } from "../registration/RehearsalStrip";
import { CertificateCard } from "./CertificateCard";
import { PoseCollection } from "./PoseCollection";
import type { Purpose } from "./toolRecord";
import { NewTool } from "./NewTool";
import { ToolCard } from "./ToolCard";

const ASK_EVERY_MS = 2000;

/** The tool page: pivot, spin and tip check, with live progress. */
export function ToolPage(): ReactNode {
  const texts = useTexts().tool;
  const procedure = useProcedure();
  const gates = useGates();
  const documents = useDocuments();
  const query = useQuery((signal) => getTools({ signal }), {
    everyMs: ASK_EVERY_MS,
  });
  const { data, refetch } = query;
  const beginning = useAction();
  const [storedHere, setStoredHere] = useState<string | null>(null);
  const begin = (tool: string, purpose: Purpose, marker: string | null): void => {
    void beginning
      .run(async () => {
        await postToolsCollection({ body: { tool, purpose, marker } });
      })
      .then(refetch);
  };
  const over = (stored: string | null): void => {
    setStoredHere(stored);
    refetch();
    procedure.refetch();
  };
  if (data === null) return <QueryStatus query={query} />;
  if (gates.data === null) return <QueryStatus query={gates} />;
  if (procedure.data === null && procedure.rejection === null) return <QueryStatus query={procedure} />;
  const gate = gates.data.tool_calibration;
  if (procedure.data?.case_id === null)
    return (
      <div className="cards">
        <EmptyState drawing="case" sentence={texts.noCase}>
          <PageLink page="case" />
        </EmptyState>
        <CertificateCard />
      </div>
    );
  return (
    <div className="beside">
      <div className="beside-picture">
        <VideoPane />
        <RehearsalStrip scenes={["pivot", "spin"]} />
      </div>
      <div className="cards">
        <RejectionNote rejection={beginning.rejection} />
        {data.collecting ? (
          <PoseCollection tools={data.tools} gate={gate} onOver={over} />
        ) : (
          <>
            {data.tools.map((tool) => (
              <ToolCard
                key={tool.name}
                tool={tool}
                gate={gate}
                documents={documents}
                busy={beginning.busy}
                hasMainButton={tool === data.tools[0]}
                fresh={storedHere === tool.name ? tool.name : null}
                onBegin={begin}
              />
            ))}
            <NewTool
              first={data.tools.length === 0}
              usedNames={data.tools.map((tool) => tool.name)}
              busy={beginning.busy}
              onBegin={begin}
            />
            <CertificateCard />
          </>
        )}
      </div>
    </div>
  );
}
