import { shownNumber } from "../../live/rounding";
import type { components } from "../../schema";
import type { RegistrationWords } from "../../words/registration/en";
import { filled } from "../../words/filled";

type Capture = Pick<components["schemas"]["CaptureMessage"], "images" | "wanted" | "rate_hz" | "left_s">;
type CaptureWords = Pick<RegistrationWords["capture"], "looking" | "lookingAtRate">;

/** How many images a running capture has, and how long the tip is still to be held at the camera's rate. */
export function lookingText(capture: Capture, words: CaptureWords): string {
  const { images, wanted, rate_hz, left_s } = capture;
  if (rate_hz === null || left_s === null) return filled(words.looking, { images, wanted });
  return filled(words.lookingAtRate, {
    images,
    wanted,
    left: shownNumber(left_s, 1),
    rate: shownNumber(rate_hz, 1),
  });
}
