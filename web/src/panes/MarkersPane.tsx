import { Table } from "@mantine/core";
import type { ReactNode } from "react";
import { useLive } from "../live/LiveContext";
import type { MarkerMessage } from "../live/messages";
import { shownPercent } from "../live/rounding";
import type { Words } from "../words/en";
import { useWords } from "../words/WordsContext";
import { Pane } from "./Pane";

/** Each marker with its score and target score, as in the paper's program. */
export function MarkersPane(): ReactNode {
  const words = useWords();
  const { view } = useLive();
  // Scores belong to an image as the numbers do: they go when the image is old.
  const stale = !view.numbers.live && view.numbers.cause !== "unread";
  const markers = view.newest?.snapshot?.markers ?? [];
  return (
    <Pane id="markers" title={words.markers.title}>
      {markers.length === 0 ? (
        <p className="empty">{stale ? "—" : words.markers.none}</p>
      ) : (
        <Table verticalSpacing={6}>
          <Table.Thead>
            <Table.Tr>
              <Table.Th scope="col">{words.markers.name}</Table.Th>
              <Table.Th scope="col">{words.markers.state}</Table.Th>
              <Table.Th scope="col">{words.markers.score}</Table.Th>
              <Table.Th scope="col">{words.markers.target}</Table.Th>
            </Table.Tr>
          </Table.Thead>
          <Table.Tbody>
            {markers.map((marker) => (
              <MarkerRow key={marker.name} marker={marker} stale={stale} words={words} />
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
  words,
}: {
  marker: MarkerMessage;
  stale: boolean;
  words: Words;
}): ReactNode {
  const { sighting, name } = marker;
  const seen = sighting.kind === "seen";
  const state = seen
    ? `● ${words.markers.seen}, ${words.foundBy[sighting.found_by]}`
    : `▲▲ ${words.markers.unseen}: ${words.unseen[sighting.reason]}`;
  const score = seen ? sighting.score_ratio : sighting.best_score_ratio;
  return (
    <Table.Tr data-testid={`marker-${name}`}>
      <Table.Th scope="row">{name}</Table.Th>
      <Table.Td>{stale ? words.markers.unknown : state}</Table.Td>
      <Table.Td className="figure">{stale || score === null ? "—" : shownPercent(score)}</Table.Td>
      <Table.Td className="figure">
        {stale || !seen ? "—" : shownPercent(sighting.target_score_ratio)}
      </Table.Td>
    </Table.Tr>
  );
}
