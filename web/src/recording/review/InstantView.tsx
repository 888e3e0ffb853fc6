import type { ReactNode } from "react";
import { MARKS } from "../../alarms/AlarmSentence";
import { formatFigure, formatNumber } from "../../live/rounding";
import { FIGURES, type FigureName } from "../../panes/limits";
import { RejectionNote } from "../../rest/RejectionNote";
import { textOf } from "../../texts/text";
import type { Texts } from "../../texts/en";
import { useTexts } from "../../texts/TextsContext";
import { clockDuration } from "../recordingText";
import { displayedTool } from "./comparison";
import type { ShownInstant } from "./useShownInstant";

/** Image of an instant with its figures, limits and alarms. */
export function InstantView({ shown, images }: { shown: ShownInstant; images: number }): ReactNode {
  const texts = useTexts();
  const own = texts.recording.review;
  const { instant, source, rejection } = shown;
  const tool = instant === null ? null : displayedTool(instant);
  const assessment = tool?.assessment ?? null;
  return (
    <div className="review-instant" data-testid="review-instant" data-number={instant?.number ?? ""}>
      <figure className="review-image">
        {source === null ? (
          <p className="soft">{instant === null && rejection === null ? texts.rest.loading : own.noImage}</p>
        ) : (
          <img src={source} alt={own.image} data-testid="review-image" />
        )}
      </figure>
      <div className="review-facts">
        <RejectionNote rejection={rejection} />
        {instant !== null && (
          <p className="review-when" data-testid="review-when">
            <strong>{clockDuration(instant.at_s)}</strong> · {own.imageOf} {instant.number + 1} / {images}
            {instant.snapshot.channel_name !== null && ` · ${instant.snapshot.channel_name}`}
            {tool !== null && ` · ${tool.name}`}
          </p>
        )}
        <dl className="review-figures">
          {FIGURES.map((name) => {
            const figure = assessment?.kind === "assessment" ? assessment.figures[name] : null;
            const { name: title, unit } = texts.reading[name];
            return (
              <div key={name} className="review-figure" data-status={figure?.status ?? "none"}>
                <dt>
                  {title} <span className="unit">{unit}</span>
                </dt>
                <dd data-testid={`review-${name}`}>{figure === null ? "—" : formatFigure(figure.value)}</dd>
                <dd className="review-limit">
                  {figure?.limit == null ? "" : `${limitWord(name, texts)} ${formatNumber(figure.limit)}`}
                </dd>
              </div>
            );
          })}
        </dl>
        {assessment?.kind === "absent" && <p className="soft">{own.withheld}</p>}
        <section aria-label={texts.alarms.title}>
          {instant?.alarms === null && <p className="soft">{own.alarmsUnknown}</p>}
          {instant?.alarms?.alarms.length === 0 && <p className="soft">{texts.alarms.none}</p>}
          <ul className="alarms-list" data-testid="review-alarms">
            {instant?.alarms?.alarms.map((alarm) => (
              <li key={alarm.number} data-priority={alarm.priority} data-state={alarm.state}>
                <span aria-hidden="true">{MARKS[alarm.priority]}</span>{" "}
                <span className="heard-only">{texts.alarms.priority[alarm.priority]}</span>
                <b>{textOf(alarm.title, texts)}</b> {textOf(alarm.sentence, texts)}{" "}
                {textOf(alarm.known, texts)}
              </li>
            ))}
          </ul>
        </section>
      </div>
    </div>
  );
}

/** The wall's limit is the distance below which it is near, that of the depth the planned depth. */
function limitWord(name: FigureName, { theatre }: Texts): string {
  if (name === "wall") return theatre.nearBelow;
  return name === "depth" ? theatre.of : theatre.limit;
}
