import { Table } from "@mantine/core";
import type { ReactNode } from "react";
import { useLive } from "../live/LiveContext";
import type { MarkerMessage } from "../live/messages";
import { formatPercent } from "../live/rounding";
import type { Texts } from "../texts/en";
import { useTexts } from "../texts/TextsContext";
import { Pane } from "./Pane";

/** Each marker with its score and target score, as in the paper. */
export function MarkersPane(): ReactNode {
  const texts = useTexts();
  const { view } = useLive();
  // Scores belong to an image: they are removed when the image is too old.
  const stale = !view.numbers.live && view.numbers.cause !== "unread";
  const markers = view.newest?.snapshot?.markers ?? [];
  return (
    <Pane id="markers" title={texts.markers.title}>
      {markers.length === 0 ? (
        <p className="empty">{stale ? "—" : texts.markers.none}</p>
      ) : (
        <Table verticalSpacing={6}>
          <Table.Thead>
            <Table.Tr>
              <Table.Th scope="col">{texts.markers.name}</Table.Th>
              <Table.Th scope="col">{texts.markers.state}</Table.Th>
              <Table.Th scope="col">{texts.markers.score}</Table.Th>
              <Table.Th scope="col">{texts.markers.target}</Table.Th>
            </Table.Tr>
          </Table.Thead>
          <Table.Tbody>
            {markers.map((marker) => (
              <MarkerRow key={marker.name} marker={marker} stale={stale} texts={texts} />
            ))}
          </Table.Tbody>
        </Table>
      )}
    </Pane>
  );
}

function MarkerRow({
  marker,
  stale,
  texts,
}: {
  marker: MarkerMessage;
  stale: boolean;
  texts: Texts;
}): ReactNode {
  const { sighting, name } = marker;
  const seen = sighting.kind === "seen";
  const state = seen
    ? `● ${texts.markers.seen}, ${texts.foundBy[sighting.found_by]}`
    : `▲▲ ${texts.markers.unseen}: ${texts.unseen[sighting.reason]}`;
  const score = seen ? sighting.score_ratio : sighting.best_score_ratio;
  return (
    <Table.Tr data-testid={`marker-${name}`}>
      <Table.Th scope="row">{name}</Table.Th>
      <Table.Td>{stale ? texts.markers.unknown : state}</Table.Td>
      <Table.Td className="figure">{stale || score === null ? "—" : formatPercent(score)}</Table.Td>
      <Table.Td className="figure">
        {stale || !seen || sighting.target_score_ratio === null
          ? "—"
          : formatPercent(sighting.target_score_ratio)}
      </Table.Td>
    </Table.Tr>
  );
}
