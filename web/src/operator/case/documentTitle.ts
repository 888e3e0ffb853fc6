// What a document is called by people: the server's own names are for programs.
import type { components } from "../../schema";
import type { CaseWords } from "../../words/case/en";
import { filled } from "../../words/filled";

type Heading = Pick<components["schemas"]["HeadingMessage"], "kind" | "name">;
type Title = keyof CaseWords["titles"];

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
];

export function documentTitle({ kind, name }: Heading, words: CaseWords): string {
  for (const [ofKind, named, title] of NAMED) {
    const found = kind === ofKind ? named.exec(name) : null;
    if (found !== null) return filled(words.titles[title], { name: found[1] ?? "" });
  }
  return `${words.kinds[kind]} ${name}`;
}
