// What a document is called by people: the server's own names are for programs.
import type { components } from "../../schema";
import type { CaseTexts } from "../../texts/case/en";
import { interpolate } from "../../texts/interpolate";

type Heading = Pick<components["schemas"]["HeadingMessage"], "kind" | "name">;
type Title = keyof CaseTexts["titles"];

/** By kind, how the server names what it keeps; the bracket is what people would call it. */
const NAMED: readonly [kind: Heading["kind"], name: RegExp, title: Title][] = [
  ["check", /^registration of (.+)$/, "check"],
  ["check", /^tip of (.+)$/, "tip"],
  ["check", /^accuracy of the camera$/, "accuracy"],
  ["confirmation", /^going on with (.+)$/, "confirmation"],
  ["plan", /^active channel$/, "channel"],
  ["plan", /^main$/, "plan"],
  ["camera", /^main$/, "camera"],
  ["ct", /^main$/, "ct"],
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
