// A line of the audit log as a row of a table.

export interface AuditRow {
  number: number;
  at: string;
  who: string;
  what: string;
  changes: string[];
  result: string;
}

const text = (value: unknown): string =>
  typeof value === "string" || typeof value === "number" ? String(value) : "";

/** What cannot be read in a line is empty: a damaged one is shown as what is left of it. */
export function auditRow(line: Record<string, unknown>): AuditRow {
  const who = isRecord(line["who"]) ? line["who"] : {};
  const changes = Array.isArray(line["changes"]) ? line["changes"].filter(isRecord) : [];
  const named = isRecord(line["of"]) ? Object.values(line["of"]).map(text) : [];
  return {
    number: typeof line["number"] === "number" ? line["number"] : 0,
    at: text(line["at"]),
    who: [text(who["name"]), text(who["role"])].filter(Boolean).join(" · "),
    what: [text(line["what"]) || text(line["damaged"]), ...named].filter(Boolean).join(" · "),
    changes: changes.map(changeText),
    result: [text(line["status"]), text(line["code"])].filter(Boolean).join(" "),
  };
}

function changeText(change: Record<string, unknown>): string {
  const what = [text(change["what"]), text(change["name"])].filter(Boolean).join(" ");
  const said = text(change["said"]);
  if (said !== "") return `${what}: ${said}`;
  return `${what}: ${text(change["from"]) || "–"} → ${text(change["to"]) || "–"}`;
}

function isRecord(value: unknown): value is Record<string, unknown> {
  return typeof value === "object" && value !== null && !Array.isArray(value);
}
