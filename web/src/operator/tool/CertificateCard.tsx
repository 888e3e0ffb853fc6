import { Button } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { toolCertificateText } from "../../panes/certificateText";
import { EmptyState } from "../../panes/EmptyState";
import { QueryStatus } from "../../rest/QueryStatus";
import { RejectionNote } from "../../rest/RejectionNote";
import { useCertificates, type ToolCertification } from "../../rest/useCertificates";
import type { CertificateTexts } from "../../texts/certificate/en";
import { interpolate } from "../../texts/interpolate";
import { useTexts } from "../../texts/TextsContext";
import { Card } from "../parts/Card";
import { FileButton } from "../parts/FileButton";
import { sentence } from "../parts/format";
import { uploadFile } from "../parts/transfer";
import { useTransfer } from "../parts/useTransfer";
import { AccuracyBegin } from "./AccuracyBegin";
import { AccuracyTest } from "./AccuracyTest";

/** Whether each tool in use is certified and why not; installs a certificate, and gives it out. */
export function CertificateCard(): ReactNode {
  const texts = useTexts().certificate;
  const query = useCertificates();
  const installing = useTransfer();
  const [installed, setInstalled] = useState(0);
  const install = (file: File | undefined): void => {
    if (file === undefined) return;
    void installing
      .run(async (onMoved, signal) => {
        await uploadFile("/api/certificates", file, onMoved, signal);
        setInstalled((count) => count + 1);
      })
      .then(query.refetch);
  };
  return (
    <Card title={texts.title} testId="certificates" fresh={installed > 0 ? String(installed) : null}>
      <p>
        {texts.lead}{" "}
        <a className="big-link" href="/docs/certificate/" target="_blank" rel="noreferrer">
          {texts.guide}
        </a>
      </p>
      {query.data === null ? (
        <QueryStatus query={query} />
      ) : query.data.tools.length === 0 ? (
        <EmptyState drawing="camera" sentence={texts.noPicture} />
      ) : (
        query.data.tools.map((tool) => <ToolState key={tool.tool} tool={tool} texts={texts} />)
      )}
      <div className="row">
        <FileButton
          accept=".json,.pdf,application/json,application/pdf"
          disabled={installing.moved !== null}
          testId="certificate-file"
          onFiles={([file]) => {
            install(file);
          }}
        >
          {texts.install}
        </FileButton>
      </div>
      <RejectionNote rejection={installing.rejection} />
      {query.data !== null && (
        <details className="more" open={query.data.collecting} data-testid="accuracy">
          <summary>{texts.guided.test}</summary>
          {query.data.collecting ? (
            <AccuracyTest onOver={query.refetch} />
          ) : (
            <AccuracyBegin tools={query.data.tools.map((one) => one.tool)} onBegun={query.refetch} />
          )}
        </details>
      )}
    </Card>
  );
}

function ToolState({ tool, texts }: { tool: ToolCertification; texts: CertificateTexts }): ReactNode {
  const { problem } = tool;
  return (
    <div data-testid={`certificate-${tool.tool}`} data-certified={tool.certified}>
      <p role="status" className={tool.certified ? "good" : undefined}>
        {tool.certified && "✓ "}
        <strong>{tool.tool}</strong>: {toolCertificateText(tool, texts)}
      </p>
      {problem !== null && (
        <p className="soft" lang={problem.language}>
          {sentence(problem.message)} {problem.remedy}
        </p>
      )}
      {tool.issued_at !== null && (
        <>
          <p className="soft">{issuedText(tool.issued_at, tool.issued_by, texts)}</p>
          <div className="row">
            {(["pdf", "json"] as const).map((kind) => (
              <Button
                key={kind}
                variant="default"
                size="lg"
                component="a"
                href={`/api/certificates/${encodeURIComponent(tool.marker)}/${kind}`}
                download
                data-testid={`certificate-${kind}`}
              >
                {texts[kind]}
              </Button>
            ))}
          </div>
        </>
      )}
    </div>
  );
}

function issuedText(at: string, by: string | null, texts: CertificateTexts): string {
  const day = at.slice(0, 10);
  if (by === null || by === "") return interpolate(texts.issuedOnly, { day });
  return interpolate(texts.issued, { day, person: by });
}
