import { Alert, Button, Table } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { getAudit } from "../../api";
import { QueryStatus } from "../../rest/QueryStatus";
import { personName } from "../../room/personName";
import { useQuery } from "../../rest/useQuery";
import { useTexts } from "../../texts/TextsContext";
import { formatSecond } from "../parts/format";
import { auditRow } from "./auditRow";
import { pluralize } from "../../texts/pluralize";

const LINES = 25;

/** The audit log, newest line first, and whether it is intact. */
export function AuditLog(): ReactNode {
  const all = useTexts();
  const texts = all.people;
  const [before, setBefore] = useState<number | null>(null);
  const range = before === null ? { last: LINES } : { last: LINES, before };
  const query = useQuery((signal) => getAudit({ query: range, signal }), {
    key: String(before),
  });
  const { data, refetch } = query;
  const rows = (data?.lines ?? []).map((line) => auditRow(line, all)).reverse();
  const oldest = rows.at(-1)?.number ?? 0;
  return (
    <section className="audit" aria-labelledby="audit">
      <h3 id="audit">{texts.log}</h3>
      {data === null && <QueryStatus query={query} />}
      {data?.is_intact === true && (
        <p>
          ✓ {texts.whole} · {pluralize(texts.lines, data.count, all.language)}
          {data.sum !== "" && (
            <>
              {" "}
              · <code title={data.sum}>{data.sum.slice(0, 16)}</code>
            </>
          )}
        </p>
      )}
      {data?.is_intact === false && (
        <Alert role="alert" title={`${texts.broken} ${String(data.fault_line)}: ${data.fault}`}>
          {texts.brokenRemedy}
        </Alert>
      )}
      <div className="people-scroll stacked" tabIndex={0} role="region" aria-label={texts.log}>
        <Table>
          <Table.Thead>
            <Table.Tr>
              <Table.Th>#</Table.Th>
              <Table.Th>{texts.when}</Table.Th>
              <Table.Th>{texts.who}</Table.Th>
              <Table.Th>{texts.what}</Table.Th>
              <Table.Th>{texts.result}</Table.Th>
            </Table.Tr>
          </Table.Thead>
          <Table.Tbody>
            {rows.map((row) => (
              <Table.Tr key={row.number}>
                <Table.Td>{row.number}</Table.Td>
                <Table.Td>{row.at === "" ? "" : formatSecond(row.at, all.language)}</Table.Td>
                <Table.Td>{personName(row.who, all)}</Table.Td>
                <Table.Td title={row.written}>
                  {row.what}
                  {row.changes.map((change) => (
                    <small key={change}>{change}</small>
                  ))}
                </Table.Td>
                <Table.Td>
                  {row.result}
                  {row.code !== "" && <small>{row.code}</small>}
                </Table.Td>
              </Table.Tr>
            ))}
          </Table.Tbody>
        </Table>
      </div>
      <div className="people-row">
        <Button
          size="lg"
          variant="default"
          disabled={oldest <= 1}
          onClick={() => {
            setBefore(oldest);
          }}
        >
          {texts.older}
        </Button>
        <Button
          size="lg"
          variant="default"
          onClick={() => {
            setBefore(null);
            refetch();
          }}
        >
          {texts.newest}
        </Button>
        <Button size="lg" variant="default" component="a" href="/api/audit/export" download>
          {texts.export}
        </Button>
      </div>
    </section>
  );
}
