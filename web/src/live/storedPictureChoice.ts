// The picture's size that was chosen on this device, kept over visits.
import { PICTURE_CHOICES, type PictureChoice } from "./pictureDelivery";

const KEY = "coaxial.picture-size";

export function storedPictureChoice(): PictureChoice {
  try {
    const stored = localStorage.getItem(KEY);
    return PICTURE_CHOICES.find((choice) => choice === stored) ?? "auto";
  } catch {
    // A browser that keeps nothing: as on the first visit.
    return "auto";
  }
}

export function storePictureChoice(choice: PictureChoice): void {
  try {
    localStorage.setItem(KEY, choice);
  } catch {
    // Then it holds for this visit.
  }
}
