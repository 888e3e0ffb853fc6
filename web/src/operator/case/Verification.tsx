import { Button } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { RejectionNote } from "../../rest/RejectionNote";
import { useQuery } from "../../rest/useQuery";
import { useAction } from "../../rest/useAction";
import { getCasesByCaseIdFiles, postCasesByCaseIdVerification, type VerificationMessage } from "../../api";
import { useTexts } from "../../texts/TextsContext";
import { Card } from "../parts/Card";
import { formatBytes } from "../parts/format";
import { pluralize } from "../../texts/pluralize";
import { DamageList } from "./DamageList";

/** Verifies all files of a case on request. */
export function Verification({ caseId }: { caseId: string }): ReactNode {
  const { case: texts, rest, language } = useTexts();
  const [found, setFound] = useState<VerificationMessage | null>(null);
  const verifying = useAction();
  const path = { case_id: caseId };
  const { data, rejection } = useQuery((signal) => getCasesByCaseIdFiles({ signal, path }), {
    key: caseId,
    everyMs: 5000,
  });
  const verify = (): void => {
    setFound(null);
    void verifying.run(async () => {
      setFound(await postCasesByCaseIdVerification({ path }));
    });
  };
  const bytes = (data?.files ?? []).reduce((sum, file) => sum + file.size_bytes, 0);
  return (
    <Card title={texts.filesTitle} testId="files">
      <RejectionNote rejection={rejection} />
      <div className="row row-mid">
        <p className="grow">
          {data === null
            ? rejection === null && rest.loading
            : pluralize(texts.filesCount, data.files.length, language, { size: formatBytes(bytes) })}
        </p>
        <Button size="lg" variant="default" loading={verifying.busy} onClick={verify}>
          {texts.verify}
        </Button>
      </div>
      <RejectionNote rejection={verifying.rejection} />
      {found?.sound === true && (
        <p role="status" className="good">
          ✓ {texts.filesSound}
        </p>
      )}
      {found?.sound === false && (
        <div role="alert" className="bad stack">
          <p>▲ {texts.filesDamaged}</p>
          <DamageList damages={found.damages} />
          <p>{texts.filesRemedy}</p>
        </div>
      )}
    </Card>
  );
}
