// Loads a slice: pixels and position from one answer.
import { NO_ANSWER, Rejection, type Problem } from "../../../rest/client";
import { pageLanguage } from "../../../texts/pageLanguage";
import type { Place } from "./place";
import { SliceRepository } from "./sliceLoader";

export interface Slice {
  pixels: ImageBitmap;
  place: Place;
}

// About 1 MB each.
const MAX_STORED = 80;

/** Cache shared by all views, so that a slice is not fetched twice. */
export const sliceRepository = new SliceRepository<Slice>(MAX_STORED);

/** The case now has another CT than the displayed one. */
export class OtherCt extends Error {}

/**
 * Returns the slice at this address.
 *
 * @throws Rejection
 * @throws OtherCt
 */
export async function loadSlice(address: string): Promise<Slice> {
  let answer: Response;
  try {
    answer = await fetch(address, { headers: { "Accept-Language": pageLanguage() } });
  } catch {
    throw new Rejection(NO_ANSWER);
  }
  if (!answer.ok) throw new Rejection((await answer.json()) as Problem);
  const placeHeader = answer.headers.get("slice-place");
  if (placeHeader === null) throw new Error("a slice came without its place");
  // Another CT may have been sent meanwhile; its slices must not appear with this CT's values.
  const { hash } = new URL(address, location.origin);
  if (answer.headers.get("slice-ct") !== hash.slice(1)) throw new OtherCt();
  const place = JSON.parse(placeHeader) as Place;
  return { pixels: await createImageBitmap(await answer.blob()), place };
}
