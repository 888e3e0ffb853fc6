import type { ReactNode } from "react";
import { getLabelsOutlines, type GetLabelsOutlinesData } from "../../../api";
import { useQuery } from "../../../rest/useQuery";
import { pathOf, type Projection } from "../slices/projection";
import { vec3, type Vec3 } from "../slices/vectors";
import { useLabels } from "./LabelsContext";
import { shadeOf } from "./shade";

type Matrix = GetLabelsOutlinesData["query"]["lps_from_px"];

/** Outlines of the labels on a slice, each with its level. */
export function LabelDrawing({ projection }: { projection: Projection }): ReactNode {
  const { labels, isShown } = useLabels();
  return labels !== null && isShown ? <Outlines projection={projection} of={labels.heading.id} /> : null;
}

function Outlines({ projection, of }: { projection: Projection; of: string }): ReactNode {
  const { lps_from_px, width_px, height_px } = projection.place;
  // Outlines of another slice are not drawn: the answer belongs to its key.
  const query = { lps_from_px: lps_from_px.flat() as Matrix, width_px, height_px };
  const { data } = useQuery((signal) => getLabelsOutlines({ query, signal }), {
    key: `${of} ${JSON.stringify(query)}`,
  });
  return (
    <g className="draw-labels" data-testid="draw-labels">
      {data?.outlines.map(({ level, rings_lps_mm, name_lps_mm }) => {
        const rings = rings_lps_mm.map((ring) =>
          ring.map(vec3).filter((point): point is Vec3 => point !== null),
        );
        const name = vec3(name_lps_mm);
        const [x, y] = name === null ? [0, 0] : projection.at(name);
        return (
          <g key={level} data-shade={shadeOf(level)}>
            <path d={rings.map((ring) => pathOf(projection, ring, { closed: true })).join(" ")} />
            {name !== null && (
              <text x={x} y={y} textAnchor="middle" dominantBaseline="middle">
                {level}
              </text>
            )}
          </g>
        );
      })}
    </g>
  );
}
