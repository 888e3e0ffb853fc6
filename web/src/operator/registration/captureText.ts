import { formatNumber } from "../../live/rounding";
import type { CaptureMessage } from "../../api";
import type { RegistrationTexts } from "../../texts/registration/en";
import { interpolate } from "../../texts/interpolate";

type Capture = Pick<CaptureMessage, "images" | "wanted" | "rate_hz" | "left_s">;
type CaptureTexts = Pick<RegistrationTexts["capture"], "looking" | "lookingAtRate">;

/** Images of a running capture, and the remaining time at the camera's rate. */
export function captureText(capture: Capture, texts: CaptureTexts): string {
  const { images, wanted, rate_hz, left_s } = capture;
  if (rate_hz === null || left_s === null) return interpolate(texts.looking, { images, wanted });
  return interpolate(texts.lookingAtRate, {
    images,
    wanted,
    left: formatNumber(left_s, 1),
    rate: formatNumber(rate_hz, 1),
  });
}
