import type { ReactNode } from "react";
import { EmptyState } from "../../panes/EmptyState";
import { QueryStatus } from "../../rest/QueryStatus";
import { useQuery } from "../../rest/useQuery";
import { getMarkers, type TrackerConfig } from "../../api";
import { useTexts } from "../../texts/TextsContext";
import { Card } from "../parts/Card";
import { MarkerRow } from "./MarkerRow";
import { NewMarker } from "./NewMarker";

export type MarkerGate = TrackerConfig;

interface MarkersProps {
  gate: MarkerGate;
  /** Whether a case is open to store a marker in; null until known. */
  canAdd: boolean | null;
  onChange: () => void;
}

/** The loaded markers with their live detection, and a form to add one. */
export function Markers({ gate, canAdd, onChange }: MarkersProps): ReactNode {
  const texts = useTexts().camera;
  const query = useQuery((signal) => getMarkers({ signal }), {
    everyMs: 3000,
  });
  const { data, refetch } = query;
  const changed = (): void => {
    refetch();
    onChange();
  };
  return (
    <Card title={texts.markersTitle} testId="markers">
      {data === null && <QueryStatus query={query} />}
      {data?.markers.length === 0 && <EmptyState drawing="marker" sentence={texts.noMarkers} />}
      <ul className="rows">
        {data?.markers.map((marker) => (
          <MarkerRow key={marker.name} marker={marker} gate={gate} onRemoved={changed} />
        ))}
      </ul>
      {canAdd === true && <NewMarker known={data?.markers ?? []} onAdded={changed} />}
      {canAdd === false && <p className="soft">{texts.markerNeedsCase}</p>}
    </Card>
  );
}
