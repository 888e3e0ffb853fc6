// What a person's pages show, in words.
import type { Picture, ViewPart } from "../api";
import { formatNumber } from "../live/rounding";
import type { Texts } from "../texts/catalogue";
import type { PageLook } from "./messages";

/** The layout or page, and the largest picture with its age. */
export function shortLookText({ part, pictures, freshness, max_age_ms }: PageLook, texts: Texts): string {
  const [largest] = pictures;
  const shown = largest === undefined ? null : pictureText(largest, texts);
  return listed([part === null ? null : partText(part, texts), shown, ageText(freshness, max_age_ms, texts)]);
}

/** The view with its layout or page, all visible pictures, the largest first, and their age. */
export function lookText(page: PageLook, texts: Texts): string {
  const part = page.part === null ? "" : `, ${partText(page.part, texts)}`;
  const pictures = page.pictures.map((one) => pictureText(one, texts)).join(", ");
  return listed([
    `${texts.shell.view[page.view]}${part}`,
    pictures,
    ageText(page.freshness, page.max_age_ms, texts),
  ]);
}

function ageText(freshness: PageLook["freshness"], maxAgeMs: number | null, { room }: Texts): string {
  if (freshness !== "live") return room.freshness[freshness];
  return maxAgeMs === null ? "" : room.upTo.replace("#", formatNumber(maxAgeMs, 0));
}

function partText(part: ViewPart, { room, theatre, operator }: Texts): string {
  const { name } = theatre.layouts;
  if (part === "figures") return room.figures;
  return part in name ? name[part as keyof typeof name] : operator.page[part as keyof typeof operator.page];
}

function pictureText(picture: Picture, { video, scene, theatre }: Texts): string {
  if (picture === "video") return video.title;
  return picture === "scene" ? scene.title : theatre.cuts.title[picture];
}

function listed(parts: readonly (string | null)[]): string {
  return parts.filter((one) => one !== null && one !== "").join(" · ");
}
