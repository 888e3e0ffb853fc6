import type { ReactNode } from "react";
import { useTexts } from "../../../texts/TextsContext";
import { areSame, draftLines } from "../lines/draftLines";
import { isFlat, type PlaneName } from "../slices/address";
import type { Projection } from "../slices/projection";
import { useSlices } from "../slices/SlicesContext";
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
import { LandmarksDrawing } from "./LandmarksDrawing";
import { LinesDrawing } from "./LinesDrawing";
import { PedicleDrawing } from "./PedicleDrawing";

/** All parts of the plan on this slice, the cross, and unsaved drafts. */
export function PlanDrawing({ plane, projection }: { plane: PlaneName; projection: Projection }): ReactNode {
  const { vertebrae, vertebra } = usePlanning();
  const { look } = useSlices();
  const { part, apartMm } = useWork();
  const reference = vertebra?.references[0] ?? null;
  const lines = draftLines(look.cursor, apartMm);
  const isLaid = reference !== null && areSame(lines, reference.lines);
  return (
    <>
      {part === "surface" && <SurfaceOutline projection={projection} />}
      {vertebrae.map((one) => (
        <VertebraDrawing key={one.name} vertebra={one} projection={projection} />
      ))}
      {part === "lines" && plane === "axial" && vertebra !== null && !isLaid && (
        <LinesDrawing projection={projection} lines={lines} isDraft />
      )}
      <Cross projection={projection} cursor={look.cursor} />
      <DraftDrawing plane={plane} projection={projection} />
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

function DraftDrawing({ plane, projection }: { plane: PlaneName; projection: Projection }): ReactNode {
  const texts = useTexts().plan.byHand;
  const large = useSlices().plane;
  const { part, draft, setDraft } = useWork();
  if (draft === null || part !== "channel") return null;
  const { of, channel } = draft;
  const { entry, target } = channel;
  const [ex, ey] = projection.at(entry);
  const [tx, ty] = projection.at(target);
  const isEditable = plane === large && (isFlat(plane) || plane === "along");
  const put = (changed: Partial<typeof channel>): void => {
    setDraft({ of, channel: { ...channel, ...changed } });
  };
  return (
    <>
      <ChannelDrawing
        projection={projection}
        entry={entry}
        target={target}
        radiusMm={channel.diameterMm / 2}
        look="draft"
      />
      {isEditable && (
        <>
          <Handle
            projection={projection}
            name="entry"
            label={texts.moved.entry}
            point={entry}
            towards={[ex - tx, ey - ty]}
            onMove={(point) => {
              put({ entry: point });
            }}
          />
          <Handle
            projection={projection}
            name="target"
            label={texts.moved.target}
            point={target}
            towards={[tx - ex, ty - ey]}
            onMove={(point) => {
              put({ target: point });
            }}
          />
        </>
      )}
    </>
  );
}
