import type { ReactNode } from "react";
import { answered, server } from "../../rest/client";
import { RefusalNote } from "../../rest/RefusalNote";
import { useAsked } from "../../rest/useAsked";
import type { components } from "../../schema";
import { useWords } from "../../words/WordsContext";
import { Card } from "../parts/Card";
import { MarkerRow } from "./MarkerRow";
import { NewMarker } from "./NewMarker";

export type MarkerGate = components["schemas"]["TrackerConfig"];

interface MarkersProps {
  gate: MarkerGate;
  canAdd: boolean;
  onChange: () => void;
}

/** The markers that are looked for, with their pictures and their search as it goes; another one sent. */
export function Markers({ gate, canAdd, onChange }: MarkersProps): ReactNode {
  const words = useWords().camera;
  const { data, refusal, again } = useAsked((signal) => answered(server.GET("/api/markers", { signal })), {
    everyMs: 3000,
  });
  const changed = (): void => {
    again();
    onChange();
  };
  return (
    <Card title={words.markersTitle} testId="markers">
      <RefusalNote refusal={refusal} />
      {data?.markers.length === 0 && <p className="card-lead">{words.noMarkers}</p>}
      <ul className="rows">
        {data?.markers.map((marker) => (
          <MarkerRow key={marker.name} marker={marker} gate={gate} onRemoved={changed} />
        ))}
      </ul>
      {canAdd ? (
        <NewMarker known={data?.markers ?? []} onAdded={changed} />
      ) : (
        <p className="soft">{words.markerNeedsCase}</p>
      )}
    </Card>
  );
}
