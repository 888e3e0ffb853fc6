import type { ReactNode } from "react";
import { GuideLink } from "../help/GuideLink";
import { useTexts } from "../texts/TextsContext";

/** Prints a new link for the operator: in a checkout, and where Coaxial is installed. */
const NEW_LINK = ['make run ARGS="--new-operator-link"', "coaxial run --new-operator-link"];

/** Where a sign-in link comes from, and what to do without one. */
export function LinkHelp(): ReactNode {
  const texts = useTexts().signIn.help;
  return (
    <div className="enter-help">
      <h2>{texts.title}</h2>
      <dl>
        <dt>{texts.started.who}</dt>
        <dd>
          {texts.started.how} <code lang="en">Sign in as operator (once): …/enter#…</code>
        </dd>
        <dt>{texts.invited.who}</dt>
        <dd>{texts.invited.how}</dd>
        <dt>{texts.lost.who}</dt>
        <dd>
          {texts.lost.how}{" "}
          {NEW_LINK.map((command) => (
            <code key={command}>{command}</code>
          ))}
        </dd>
      </dl>
      <GuideLink place="signIn">{texts.guide}</GuideLink>
    </div>
  );
}
