import type { ReactNode } from "react";
import { useLive } from "../../live/LiveContext";
import { RejectionNote } from "../../rest/RejectionNote";
import { useAction } from "../../rest/useAction";
import { deleteMarkersByName, type KnownMarkerMessage } from "../../api";
import { useTexts } from "../../texts/TextsContext";
import { Maker } from "../parts/Maker";
import { ConfirmButton } from "../parts/ConfirmButton";
import { useMaker } from "../parts/useMaker";
import type { MarkerGate } from "./Markers";
import { ScoreBar } from "./ScoreBar";

export type KnownMarker = KnownMarkerMessage;

interface MarkerRowProps {
  marker: KnownMarker;
  gate: MarkerGate;
  onRemoved: () => void;
}

/** One marker: picture, size, and its detection in the newest image. */
export function MarkerRow({ marker, gate, onRemoved }: MarkerRowProps): ReactNode {
  const texts = useTexts();
  const { view } = useLive();
  const madeBy = useMaker();
  const removing = useAction();
  // Scores belong to an image: they are removed when it is too old.
  const stale = !view.numbers.live && view.numbers.cause !== "unread";
  const found = view.newest?.snapshot?.markers.find((one) => one.name === marker.name) ?? null;
  const sighting = stale ? null : (found?.sighting ?? null);
  const seen = sighting?.kind === "seen" ? sighting : null;
  const state =
    sighting === null
      ? view.firstMessage === "awaited"
        ? texts.rest.loading
        : texts.camera.notSearched
      : sighting.kind === "seen"
        ? `● ${texts.markers.seen}, ${texts.foundBy[sighting.found_by]}`
        : `▲ ${texts.markers.unseen}: ${texts.unseen[sighting.reason]}`;
  const remove = (): void => {
    void removing
      .run(async () => {
        const options = { path: { name: marker.name }, query: { made_by: madeBy } };
        await deleteMarkersByName(options);
      })
      .then(onRemoved);
  };
  // A rigid body of an external tracker has no picture.
  const isPrinted = marker.side_mm !== null;
  // A new picture under the same name is another document and must not come from the browser's cache.
  const address = `/api/markers/${marker.name}/picture?document=${marker.document_id ?? "settings"}`;
  return (
    <li className="marker-row" data-testid={`marker-${marker.name}`} data-seen={seen !== null}>
      {isPrinted && (
        <img src={address} alt={`${texts.camera.pictureOf} ${marker.name}`} width={112} height={112} />
      )}
      <div className="stack grow">
        <p>
          <strong className="case-name">{marker.name}</strong>{" "}
          <span className="soft">
            {isPrinted && `${texts.camera.side} ${String(marker.side_mm)} mm · `}
            {marker.document_id === null ? (
              texts.camera.ofSettings
            ) : (
              <>
                {texts.camera.ofCase}, <Maker of={marker} />
              </>
            )}
          </span>
        </p>
        <p className={seen === null ? "bad" : "good"}>{state}</p>
        {isPrinted && (
          <>
            <ScoreBar
              name={texts.markers.score}
              ratio={seen?.score_ratio ?? (sighting?.kind === "unseen" ? sighting.best_score_ratio : null)}
              acceptRatio={gate.accept_score_ratio}
            />
            <ScoreBar
              name={texts.markers.target}
              ratio={seen?.target_score_ratio ?? null}
              acceptRatio={gate.accept_target_score_ratio}
            />
          </>
        )}
      </div>
      {marker.document_id !== null && (
        <ConfirmButton confirmLabel={texts.camera.removeSure} loading={removing.busy} onConfirm={remove}>
          {texts.camera.remove}
        </ConfirmButton>
      )}
      <RejectionNote rejection={removing.rejection} />
    </li>
  );
}
