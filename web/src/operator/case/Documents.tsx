import { Badge, Button, Switch, Table } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { EmptyState } from "../../panes/EmptyState";
import { QueryStatus } from "../../rest/QueryStatus";
import { useQuery } from "../../rest/useQuery";
import {
  getCasesByCaseIdDocuments,
  postCasesByCaseIdDocumentsByDocumentIdRestoration,
  type HeadingMessage,
} from "../../api";
import { RejectionNote } from "../../rest/RejectionNote";
import { useAction } from "../../rest/useAction";
import { useTexts } from "../../texts/TextsContext";
import { Card } from "../parts/Card";
import { Maker } from "../parts/Maker";
import { sentence, formatTime } from "../parts/format";
import { useMadeBy } from "../registration/useMadeBy";
import { documentTitle } from "./documentTitle";
import { lastIntact, newestOf } from "./newest";

type Heading = HeadingMessage;

const ASK_EVERY_MS = 3000;

/** Documents of the case with their validity and the reason if they are not valid. */
export function Documents({ caseId }: { caseId: string }): ReactNode {
  const texts = useTexts().case;
  const [all, setAll] = useState(false);
  const query = useQuery((signal) => getCasesByCaseIdDocuments({ signal, path: { case_id: caseId } }), {
    key: caseId,
    everyMs: ASK_EVERY_MS,
  });
  const { data } = query;
  const shown = data === null ? [] : all ? [...data.documents].reverse() : newestOf(data.documents);
  return (
    <Card
      title={texts.documentsTitle}
      testId="documents"
      aside={
        <Switch
          size="lg"
          label={texts.allVersions}
          checked={all}
          onChange={(event) => {
            setAll(event.currentTarget.checked);
          }}
        />
      }
    >
      {data === null && <QueryStatus query={query} />}
      {data !== null && shown.length === 0 && <EmptyState drawing="log" sentence={texts.noDocuments} />}
      {shown.length > 0 && (
        <div className="stacked">
          <Table verticalSpacing="sm">
            <Table.Thead>
              <Table.Tr>
                <Table.Th scope="col">{texts.document}</Table.Th>
                <Table.Th scope="col">{texts.validity}</Table.Th>
                <Table.Th scope="col">{texts.made}</Table.Th>
              </Table.Tr>
            </Table.Thead>
            <Table.Tbody>
              {shown.map((one) => (
                <DocumentRow key={one.id} heading={one}>
                  {data !== null && (
                    <GoOn
                      caseId={caseId}
                      intact={lastIntact(data.documents, one)}
                      onRestored={query.refetch}
                    />
                  )}
                </DocumentRow>
              ))}
            </Table.Tbody>
          </Table>
        </div>
      )}
    </Card>
  );
}

interface GoOnProps {
  caseId: string;
  intact: Heading | null;
  onRestored: () => void;
}

/** Makes the last intact version the newest one, where the newest one is damaged. */
function GoOn({ caseId, intact, onRestored }: GoOnProps): ReactNode {
  const texts = useTexts().case;
  const by = useMadeBy();
  const restoring = useAction();
  if (intact === null) return null;
  return (
    <>
      <Button
        size="lg"
        variant="default"
        loading={restoring.busy}
        onClick={() => {
          void restoring
            .run(async () => {
              const path = { case_id: caseId, document_id: intact.id };
              await postCasesByCaseIdDocumentsByDocumentIdRestoration({ path, body: { by } });
            })
            .then(onRestored);
        }}
      >
        {texts.goOnWith.replace("{version}", String(intact.version))}
      </Button>
      <RejectionNote rejection={restoring.rejection} />
    </>
  );
}

function DocumentRow({ heading, children }: { heading: Heading; children: ReactNode }): ReactNode {
  const texts = useTexts();
  const { current, withdrawn, out_of_date: why } = heading;
  const state = heading.is_damaged
    ? "damaged"
    : withdrawn !== null
      ? "withdrawn"
      : current
        ? "current"
        : "outOfDate";
  return (
    <Table.Tr data-validity={state}>
      <Table.Th scope="row">
        {documentTitle(heading, texts.case)}{" "}
        <span className="soft">
          {texts.case.version} {heading.version}
        </span>
      </Table.Th>
      <Table.Td>
        <Badge size="lg" variant="light" color={current ? "teal" : heading.is_damaged ? "red" : "yellow"}>
          {current ? "✓" : "!"} {texts.case.validities[state]}
        </Badge>
        {why !== null && <p className="soft">{sentence(why)}</p>}
        {withdrawn !== null && (
          <p className="soft">
            {sentence(withdrawn.reason)} ({withdrawn.by})
          </p>
        )}
        {children}
      </Table.Td>
      <Table.Td>
        {!heading.is_damaged && (
          <>
            {formatTime(heading.made_at, texts.language)}{" "}
            <span className="soft">
              · <Maker of={heading} />
            </span>
          </>
        )}
      </Table.Td>
    </Table.Tr>
  );
}
