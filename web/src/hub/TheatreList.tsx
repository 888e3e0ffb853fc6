import type { ReactNode } from "react";
import { MARKS } from "../alarms/AlarmSentence";
import { SignedIn } from "../app/SignedIn";
import { useSession } from "../app/session";
import { PeoplePage } from "../operator/people/PeoplePage";
import { EmptyState } from "../panes/EmptyState";
import { TONE_SYMBOL } from "../panes/verdictText";
import { Fold } from "../supervisor/Fold";
import { interpolate } from "../texts/interpolate";
import { useTexts } from "../texts/TextsContext";
import { ThemeButton } from "../theme/ThemeButton";
import { formatBound, isHubSilent, theatresAt, type Heard, type ShownTheatre } from "./heard";
import { HubNote } from "./HubNote";
import { TheatrePicture } from "./TheatrePicture";
import { useTheatres } from "./useTheatres";

/** All theatres that this account may see. */
export function TheatreList(): ReactNode {
  const all = useTexts();
  const texts = all.hub;
  const { session } = useSession();
  const { heard, problem, nowMs } = useTheatres();
  const isOperator = session.state === "in" && session.who.role === "operator";
  return (
    <div className="supervisor hub">
      <header className="supervisor-top">
        <h1>
          {all.product} <small>{texts.title}</small>
        </h1>
        <p className="notice">
          {all.notice}. <span className="notice-more">{texts.nothingMoves}</span>
        </p>
        <ThemeButton />
        <SignedIn />
      </header>
      <HubNote heard={heard} problem={problem} nowMs={nowMs} />
      {heard !== null && <List heard={heard} nowMs={nowMs} />}
      {isOperator && (
        <section className="supervisor-folds">
          <Fold id="people" title={all.operator.page.people}>
            <PeoplePage />
          </Fold>
        </section>
      )}
    </div>
  );
}

function List({ heard, nowMs }: { heard: Heard; nowMs: number }): ReactNode {
  const texts = useTexts().hub;
  const { session } = useSession();
  const { sees, stale_after_ms: staleAfterMs } = heard.message;
  const theatres = theatresAt(heard, nowMs);
  const name = session.state === "in" ? session.who.name : "";
  if (theatres.length === 0) {
    const sentence =
      sees.length === 0
        ? interpolate(texts.seesNothing, { name })
        : interpolate(texts.noneHeard, { names: sees.join(", ") });
    return <EmptyState drawing="log" sentence={sentence} testId="no-theatre" />;
  }
  return (
    <main className="theatres" data-testid="theatres" data-silent={isHubSilent(heard, nowMs)}>
      {theatres.map((one) => (
        <Card key={one.name} theatre={one} nowMs={nowMs} staleAfterMs={staleAfterMs} />
      ))}
    </main>
  );
}

function Card({
  theatre,
  nowMs,
  staleAfterMs,
}: {
  theatre: ShownTheatre;
  nowMs: number;
  staleAfterMs: number;
}): ReactNode {
  const all = useTexts();
  const texts = all.hub;
  const { name, presence, state, ageMs, imageAgeMs } = theatre;
  return (
    <article className="theatre-card" data-testid={`theatre-${name}`} data-presence={presence}>
      <h2>
        {/* Another document: nothing of one theatre can appear under the name of another. */}
        <a href={`/theatres/${encodeURIComponent(name)}${location.search}`}>{name}</a>
        <small>
          {texts.presence[presence]}
          {state === null && ageMs !== null && ` · ${texts.lastHeard} ${formatBound(ageMs)}`}
        </small>
      </h2>
      {state === null ? (
        <p className="theatre-covered">{texts.covered[presence === "live" ? "stale" : presence]}</p>
      ) : (
        <>
          <p className="theatre-headline" data-tone={state.tone}>
            <span aria-hidden="true">{TONE_SYMBOL[state.tone as keyof typeof TONE_SYMBOL]}</span>{" "}
            {state.headline}
          </p>
          <ul className="theatre-alarms" aria-label={all.alarms.title}>
            {state.alarms.map((one, index) => (
              <li key={`${one.title} ${index}`} data-priority={one.priority} data-state={one.state}>
                <span aria-hidden="true">{MARKS[one.priority as keyof typeof MARKS]}</span>{" "}
                <span className="heard-only">
                  {all.alarms.priority[one.priority as keyof typeof all.alarms.priority]}
                </span>
                {one.title}
              </li>
            ))}
          </ul>
          <TheatrePicture theatre={name} nowMs={nowMs} staleAfterMs={staleAfterMs} />
          <p className="soft" data-testid="image-age">
            {texts.newestImage}:{" "}
            {imageAgeMs === null ? texts.noImage : `${texts.atMost} ${formatBound(imageAgeMs)}`}
          </p>
        </>
      )}
    </article>
  );
}
