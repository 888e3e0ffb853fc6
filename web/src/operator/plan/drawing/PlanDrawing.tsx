import type { ReactNode } from "react";
import { useTexts } from "../../../texts/TextsContext";
import { middleOf, MOVED, shiftChannel, type Moved } from "../channel/draft";
import { areSame, draftLines } from "../lines/draftLines";
import { LabelDrawing } from "../labels/LabelDrawing";
import type { PlaneName } from "../slices/address";
import type { Projection } from "../slices/projection";
import { useSlices } from "../slices/SlicesContext";
import { minus } from "../slices/vectors";
import { usePlanning } from "../state/PlanContext";
import { SIDES, usedPedicle, type Screw, type Side, type Vertebra } from "../state/shape";
import type { Clearances } from "../state/useClearances";
import { useWork } from "../state/WorkContext";
import { SurfaceDrawing } from "../surface/SurfaceDrawing";
import { useTriangles } from "../surface/useTriangles";
import { ChannelDrawing } from "./ChannelDrawing";
import { partsOf, type Part } from "./clearance";
import { Cross } from "./Cross";
import { Handle } from "./Handle";
import { knobsOf } from "./knobs";
import { LandmarksDrawing } from "./LandmarksDrawing";
import { LinesDrawing } from "./LinesDrawing";
import { MeasureDrawing } from "./MeasureDrawing";
import { PedicleDrawing } from "./PedicleDrawing";

/** All parts of the plan on this slice, the cross, and unsaved drafts. */
export function PlanDrawing({ plane, projection }: { plane: PlaneName; projection: Projection }): ReactNode {
  const { vertebrae, vertebra } = usePlanning();
  const { look, plane: largePlane } = useSlices();
  const { part, apartMm } = useWork();
  const reference = vertebra?.references[0] ?? null;
  const lines = draftLines(look.cursor, apartMm);
  const isLaid = reference !== null && areSame(lines, reference.lines);
  return (
    <>
      <LabelDrawing projection={projection} />
      {part === "surface" && <SurfaceOutline projection={projection} />}
      {vertebrae.map((one) => (
        <VertebraDrawing key={one.name} vertebra={one} projection={projection} />
      ))}
      {part === "lines" && plane === "axial" && vertebra !== null && !isLaid && (
        <LinesDrawing projection={projection} lines={lines} isDraft />
      )}
      <Cross projection={projection} cursor={look.cursor} />
      <DraftDrawing plane={plane} projection={projection} />
      <MeasureDrawing projection={projection} isLarge={plane === largePlane} />
    </>
  );
}

function SurfaceOutline({ projection }: { projection: Projection }): ReactNode {
  const { caseId } = usePlanning();
  const triangles = useTriangles(caseId, useWork().surfaces);
  return triangles === null ? null : <SurfaceDrawing projection={projection} triangles={triangles} />;
}

function VertebraDrawing({
  vertebra,
  projection,
}: {
  vertebra: Vertebra;
  projection: Projection;
}): ReactNode {
  const { plan, clearances } = usePlanning();
  const { part, draft } = useWork();
  const active = plan?.active_channel ?? null;
  const [reference] = vertebra.references;
  return (
    <g>
      {SIDES.map((side) => usedPedicle(plan, vertebra.name, side)).map(
        (pedicle) =>
          pedicle !== null &&
          part !== "landmarks" && (
            <PedicleDrawing key={pedicle.side} projection={projection} pedicle={pedicle} />
          ),
      )}
      {vertebra.channels
        .filter((one) => draft?.of !== `${vertebra.name} ${one.side}`)
        .map(({ side, channel, screws }) => (
          <ChannelDrawing
            key={side}
            projection={projection}
            entry={channel.entry_in_vertebra_mm}
            target={channel.target_in_vertebra_mm}
            radiusMm={channel.radius_mm}
            screw={partsOfScrew(screws[0], clearances, vertebra.name, side)}
            look={active?.vertebra === vertebra.name && active.side === side ? "active" : "planned"}
          />
        ))}
      {part === "lines" && reference !== undefined && (
        <LinesDrawing projection={projection} lines={[...reference.lines, ...reference.paths]} />
      )}
      <LandmarksDrawing projection={projection} landmarks={vertebra.landmarks} />
    </g>
  );
}

function partsOfScrew(
  screw: Screw | undefined,
  clearances: Clearances | null,
  vertebra: string,
  side: Side,
): { diameter_mm: number; parts: Part[] } | undefined {
  if (screw === undefined) return undefined;
  const clearance = clearances?.of(vertebra, side) ?? null;
  const along = clearance?.kind === "known" ? clearance : null;
  return {
    diameter_mm: screw.diameter_mm,
    parts: partsOf(along, clearances?.marginMm ?? 0, screw.length_mm),
  };
}

/** In the knobs: the entry's ring, arrows' cross for all of it, and the end's cross. */
const SIGN: Record<Moved, string> = {
  entry: "M -5 0 a 5 5 0 1 0 10 0 a 5 5 0 1 0 -10 0",
  whole: "M -8 0 H 8 M 0 -8 V 8",
  target: "M -6 -6 L 6 6 M -6 6 L 6 -6",
};

function DraftDrawing({ plane, projection }: { plane: PlaneName; projection: Projection }): ReactNode {
  const texts = useTexts().plan.byHand;
  const large = useSlices().plane;
  const { part, draft, setDraft } = useWork();
  if (draft === null || part !== "channel") return null;
  const { of, channel } = draft;
  const { entry, target } = channel;
  const points = { entry, whole: middleOf(channel), target };
  const knobs = knobsOf(projection.at(entry), projection.at(target));
  return (
    <>
      <ChannelDrawing
        projection={projection}
        entry={entry}
        target={target}
        radiusMm={channel.diameterMm / 2}
        look="draft"
      />
      {plane === large &&
        MOVED.map((what) => (
          <Handle
            key={what}
            projection={projection}
            name={what}
            label={texts.moved[what]}
            sign={SIGN[what]}
            point={points[what]}
            towards={knobs[what]}
            onMove={(point) => {
              setDraft({ of, channel: shiftChannel(channel, what, minus(point, points[what])) });
            }}
          />
        ))}
    </>
  );
}
