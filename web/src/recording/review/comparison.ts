// Comparison of one instant of two recordings. Pure.
import type { Status } from "../../live/messages";
import { FIGURES, type FigureName } from "../../panes/limits";
import type { RecordedInstant } from "./useShownInstant";

type Tool = RecordedInstant["snapshot"]["tools"][number];

/** Instants further apart than this are not compared: a hand moves meanwhile. */
export const MAX_APART_S = 0.1;
/** Image times have rounding errors of a microsecond. */
const ROUNDING_S = 1e-4;

export interface ComparedValue {
  value: number;
  error95: number | null;
}

export interface ComparedFigure {
  first: ComparedValue | null;
  second: ComparedValue | null;
  /** Second minus first, of the displayed digits; null unless both have a value of the same thing at this instant. */
  difference: ComparedValue | null;
}

export interface Comparison {
  /**
   * Why there are no differences: the instants are too far apart, or a recording has no figures here. With `other-wall`
   * the clearances alone have none: they are to different walls, such as bone and the planned channel.
   */
  reason: "apart" | "first-absent" | "second-absent" | "other-wall" | null;
  /** Time of the second instant minus that of the first, after the offset. */
  apartS: number;
  figures: Record<FigureName, ComparedFigure>;
}

/** The second recording is `offsetS` later in its own time than the first. */
export function comparisonOf(first: RecordedInstant, second: RecordedInstant, offsetS: number): Comparison {
  const apartS = second.at_s - first.at_s - offsetS;
  const [firstAssessment, secondAssessment] = [displayedTool(first), displayedTool(second)].map((tool) =>
    tool?.assessment.kind === "assessment" ? tool.assessment : null,
  );
  const isOtherWall = firstAssessment?.against !== secondAssessment?.against;
  const isApart = Math.abs(apartS) > MAX_APART_S + ROUNDING_S;
  const figures = Object.fromEntries(
    FIGURES.map((name) => {
      const [one, other] = [firstAssessment, secondAssessment].map((assessment) => {
        const figure = assessment?.figures[name];
        return figure?.value == null || !isDefined(figure.status)
          ? null
          : { value: figure.value, error95: figure.error_95 };
      }) as [ComparedValue | null, ComparedValue | null];
      return [
        name,
        {
          first: one,
          second: other,
          difference: isApart || (name === "wall" && isOtherWall) ? null : difference(one, other),
        },
      ];
    }),
  ) as Record<FigureName, ComparedFigure>;
  const reason = isApart
    ? "apart"
    : firstAssessment == null
      ? "first-absent"
      : secondAssessment == null
        ? "second-absent"
        : isOtherWall
          ? "other-wall"
          : null;
  return { reason, apartS, figures };
}

/** The displayed tool, else the first, which has the reason for missing figures. */
export function displayedTool({ snapshot }: RecordedInstant): Tool | null {
  return snapshot.tools.find(({ name }) => name === snapshot.displayed_tool) ?? snapshot.tools[0] ?? null;
}

const isDefined = (status: Status): boolean => status !== "outside";

/** The errors are added, because those of two recordings with one registration are not independent. */
function difference(first: ComparedValue | null, second: ComparedValue | null): ComparedValue | null {
  if (first === null || second === null) return null;
  const error95 = first.error95 === null || second.error95 === null ? null : first.error95 + second.error95;
  return { value: second.value - first.value, error95 };
}
