// Converts a line of the audit log to a table row; the exported log is unchanged.
import type { DocumentKind } from "../../api";
import type { Texts } from "../../texts/catalogue";
import { documentTitle } from "../case/documentTitle";

interface AuditRow {
  number: number;
  at: string;
  who: string;
  what: string;
  /** The logged action, for comparison. */
  written: string;
  changes: string[];
  result: string;
  /** Code of the rejection. */
  code: string;
}

type Line = Readonly<Record<string, unknown>>;
type Kind = DocumentKind;

const REJECTED = 400;
const FAILED = 500;
/** Address parameters that people know; the others are ids. */
const SHOWN_NAMES = ["name", "side", "series", "plane"] as const;

/** Unreadable fields are empty: a damaged line is shown as far as possible. */
export function auditRow(line: Line, texts: Texts): AuditRow {
  const written = text(line["what"]) || text(line["damaged"]);
  const changes = Array.isArray(line["changes"]) ? line["changes"].filter(isRecord) : [];
  return {
    number: typeof line["number"] === "number" ? line["number"] : 0,
    at: text(line["at"]),
    who: whoText(line["who"], texts),
    what: [actionText(line, texts), ...ofText(line["of"], texts)].join(" · "),
    written,
    changes: changes.map((change) => changeText(change, texts)),
    result: resultText(line["status"], texts),
    code: text(line["code"]),
  };
}

function whoText(value: unknown, { signIn: enter, audit }: Texts): string {
  const who = isRecord(value) ? value : {};
  if (who["id"] === "server") return audit.server;
  if (who["id"] === "nobody") return audit.nobody;
  const role = text(who["role"]);
  const roles: Partial<Record<string, string>> = enter.role;
  return [text(who["name"]), roles[role] ?? role].filter(Boolean).join(" · ");
}

function actionText(line: Line, { audit }: Texts): string {
  const what = text(line["what"]);
  if (what === "") return [audit.damaged, text(line["damaged"])].filter(Boolean).join(": ");
  if (Object.hasOwn(audit.actions, what)) return audit.actions[what] ?? audit.other;
  return /^(GET|WS) /.test(what) ? audit.looked : audit.other;
}

function ofText(value: unknown, { registration }: Texts): string[] {
  const of = isRecord(value) ? value : {};
  const sides: Partial<Record<string, string>> = registration.side;
  return SHOWN_NAMES.map((name) => sides[text(of[name])] ?? text(of[name])).filter(Boolean);
}

function changeText(change: Line, texts: Texts): string {
  const title = titleOf(text(change["what"]), text(change["name"]), texts);
  const statement = text(change["said"]);
  if (statement !== "") return `${title}: ${statement}`;
  // Ids of cases are omitted, and a deleted recording has no versions.
  if (change["what"] === "open case" || change["what"] === "rotation") return title;
  const [from, to] = [text(change["from"]), text(change["to"])];
  if (typeof change["to"] === "number") {
    return `${title}: ${texts.case.version} ${from === "" ? to : `${from} → ${to}`}`;
  }
  return `${title}: ${from || "–"} → ${to || "–"}`;
}

function titleOf(what: string, name: string, { audit, case: texts }: Texts): string {
  if (Object.hasOwn(texts.kinds, what)) return documentTitle({ kind: what as Kind, name }, texts);
  const own: Partial<Record<string, string>> = {
    case: audit.caseChanged,
    "open case": audit.openCase,
    rotation: audit.rotation,
    invitation: audit.invitation,
    session: audit.session,
    "audit log": audit.log,
  };
  return [own[what] ?? what, name].filter(Boolean).join(" ");
}

function resultText(status: unknown, { audit }: Texts): string {
  if (typeof status !== "number") return "";
  if (status < REJECTED) return `✓ ${audit.done}`;
  return `✕ ${status < FAILED ? audit.rejected : audit.failed}`;
}

const text = (value: unknown): string =>
  typeof value === "string" || typeof value === "number" ? String(value) : "";

function isRecord(value: unknown): value is Record<string, unknown> {
  return typeof value === "object" && value !== null && !Array.isArray(value);
}
