// The picture's size that was chosen on this device, kept over visits.
import { PICTURE_CHOICES, type PictureChoice } from "./carried";

const KEY = "coaxial.picture-size";

export function chosenBefore(): PictureChoice {
  try {
    const kept = localStorage.getItem(KEY);
    return PICTURE_CHOICES.find((choice) => choice === kept) ?? "auto";
  } catch {
    // A browser that keeps nothing: as on the first visit.
    return "auto";
  }
}

export function keepChoice(choice: PictureChoice): void {
  try {
    localStorage.setItem(KEY, choice);
  } catch {
    // Then it holds for this visit.
  }
}
