import type { ReactNode } from "react";
import { Link, useLocation } from "wouter";
import { EmptyState } from "../../panes/EmptyState";
import { PageLink } from "../../rest/PageLink";
import { QueryStatus } from "../../rest/QueryStatus";
import { useTexts } from "../../texts/TextsContext";
import { useProcedure } from "../../app/procedure";
import { MethodChoice } from "./MethodChoice";
import { NeedlesPage } from "./needles/NeedlesPage";
import { NudgesPage } from "./nudges/NudgesPage";
import { PointsPage } from "./points/PointsPage";
import { SweepPage } from "./sweep/SweepPage";

const WAYS = { points: PointsPage, needles: NeedlesPage, sweep: SweepPage, nudges: NudgesPage } as const;
export type Way = keyof typeof WAYS;

/** Registration: `/operator/register` chooses a method, `/operator/register/<way>` is one. */
export function RegistrationPage(): ReactNode {
  const texts = useTexts().registration;
  const [path] = useLocation();
  const procedure = useProcedure();
  const step = procedure.data?.steps.find((one) => one.step === "register");
  const missing = procedure.data?.case_id == null ? "case" : procedure.data.next_step;
  const named = path.split("/")[3] ?? "";
  const way = Object.hasOwn(WAYS, named) ? (named as Way) : null;
  // Methods depend on the case and wait for the first answer. A later failure must not discard unsaved marks.
  if (step === undefined && procedure.rejection === null) return <QueryStatus query={procedure} />;
  if (step !== undefined && !step.allowed)
    return (
      <EmptyState drawing="registration" sentence={texts.shut} testId="register-shut">
        <PageLink page={missing} />
      </EmptyState>
    );
  if (way === null) return <MethodChoice />;
  const Way = WAYS[way];
  return (
    <div className="registration">
      <nav className="ways" aria-label={texts.ways}>
        <Link href="/operator/register" data-testid="back-to-ways">
          ← {texts.overview}
        </Link>
        {(Object.keys(WAYS) as Way[]).map((one) => (
          <Link
            key={one}
            href={`/operator/register/${one}`}
            aria-current={one === way ? "page" : undefined}
            data-testid={`way-${one}`}
          >
            {texts.way[one]}
          </Link>
        ))}
      </nav>
      <Way />
    </div>
  );
}
