// A slice as it is shown: pixels and place out of one answer of the server.
import { Rejection, type Problem } from "../../../rest/client";
import type { Place } from "./place";
import { SliceRepository } from "./sliceLoader";

export interface Slice {
  pixels: ImageBitmap;
  place: Place;
}

// About 1 MB each.
const MAX_STORED = 80;

/** One shelf for all views: the same slice is never fetched twice while it is there. */
export const sliceRepository = new SliceRepository<Slice>(MAX_STORED);

/** The case has another CT now than the one that is looked at. */
export class OtherCt extends Error {}

/**
 * The slice at this address.
 *
 * @throws Rejection
 * @throws OtherCt
 */
export async function loadSlice(address: string): Promise<Slice> {
  let answer: Response;
  try {
    answer = await fetch(address);
  } catch {
    throw new Rejection({ code: "NO_ANSWER", message: "", remedy: "", context: {} });
  }
  if (!answer.ok) throw new Rejection((await answer.json()) as Problem);
  const placeHeader = answer.headers.get("slice-place");
  if (placeHeader === null) throw new Error("a slice came without its place");
  // Somebody may have sent another CT meanwhile: its slices must not stand under this one's numbers.
  const { hash } = new URL(address, location.origin);
  if (answer.headers.get("slice-ct") !== hash.slice(1)) throw new OtherCt();
  const place = JSON.parse(placeHeader) as Place;
  return { pixels: await createImageBitmap(await answer.blob()), place };
}
