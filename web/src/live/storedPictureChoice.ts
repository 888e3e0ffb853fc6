// The picture size chosen on this device, stored across visits.
import { PICTURE_CHOICES, type PictureChoice } from "./pictureDelivery";

const KEY = "coaxial.picture-size";

export function storedPictureChoice(): PictureChoice {
  try {
    const stored = localStorage.getItem(KEY);
    return PICTURE_CHOICES.find((choice) => choice === stored) ?? "auto";
  } catch {
    // Storage is unavailable: same as on the first visit.
    return "auto";
  }
}

export function storePictureChoice(choice: PictureChoice): void {
  try {
    localStorage.setItem(KEY, choice);
  } catch {
    // The choice then applies to this visit only.
  }
}
