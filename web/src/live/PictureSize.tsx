import type { ReactNode } from "react";
import { useTexts } from "../texts/TextsContext";
import { PICTURE_CHOICES, type PictureChoice } from "./pictureDelivery";
import { useLive } from "./LiveContext";

/** Picture size: automatic by connection, or chosen. */
export function PictureSize(): ReactNode {
  const { connection: line } = useTexts();
  const { live, view } = useLive();
  return (
    <select
      className="picture-size"
      aria-label={line.size}
      title={line.size}
      data-testid="picture-size"
      value={view.pictureDelivery.choice}
      onChange={(event) => {
        live.choosePicture(event.currentTarget.value as PictureChoice);
      }}
    >
      {PICTURE_CHOICES.map((choice) => (
        <option key={choice} value={choice}>
          {line.sizes[choice]}
        </option>
      ))}
    </select>
  );
}
