// Titles of documents for display; the server's names are identifiers.
import type { HeadingMessage } from "../../api";
import type { CaseTexts } from "../../texts/case/en";
import { interpolate } from "../../texts/interpolate";

type Heading = Pick<HeadingMessage, "kind" | "name">;
type Title = keyof CaseTexts["titles"];

/** Patterns of the server's names by kind; the group is the displayed name. */
const NAMED: readonly [kind: Heading["kind"], name: RegExp, title: Title][] = [
  ["check", /^registration of (.+)$/, "check"],
  ["check", /^tip of (.+)$/, "tip"],
  ["check", /^accuracy of the camera$/, "accuracy"],
  ["confirmation", /^going on with (.+)$/, "confirmation"],
  ["placement", /^(.+)$/, "placement"],
  ["plan", /^active channel$/, "channel"],
  ["plan", /^main$/, "plan"],
  ["camera", /^main$/, "camera"],
  ["ct", /^main$/, "ct"],
  ["labels", /^main$/, "labels"],
  ["surface", /^main$/, "surface"],
  ["signature", /^plan /, "planSigned"],
  ["signature", /^registration (.+) by /, "registrationSigned"],
  ["registration", /^(.+)$/, "registration"],
  ["tool", /^(.+)$/, "tool"],
  ["marker", /^(.+)$/, "marker"],
  ["patient", /^/, "patient"],
  ["consent", /^/, "consent"],
  ["comment", /^/, "comment"],
];

export function documentTitle({ kind, name }: Heading, texts: CaseTexts): string {
  for (const [ofKind, named, title] of NAMED) {
    const found = kind === ofKind ? named.exec(name) : null;
    if (found !== null) return interpolate(texts.titles[title], { name: found[1] ?? "" });
  }
  return `${texts.kinds[kind]} ${name}`;
}
