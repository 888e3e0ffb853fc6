// A slice as it is shown: pixels and place out of one answer of the server.
import { Refusal, type Trouble } from "../../../rest/client";
import type { Place } from "./place";
import { SliceShelf } from "./sliceLine";

export interface Slice {
  pixels: ImageBitmap;
  place: Place;
}

// About 1 MB each.
const MOST_KEPT = 80;

/** One shelf for all views: the same slice is never fetched twice while it is there. */
export const shelf = new SliceShelf<Slice>(MOST_KEPT);

/**
 * The slice at this address.
 *
 * @throws Refusal
 */
export async function loadSlice(address: string): Promise<Slice> {
  let answer: Response;
  try {
    answer = await fetch(address);
  } catch {
    throw new Refusal({ code: "NO_ANSWER", message: "", remedy: "", context: {} });
  }
  if (!answer.ok) throw new Refusal((await answer.json()) as Trouble);
  const told = answer.headers.get("slice-place");
  if (told === null) throw new Error("a slice came without its place");
  const place = JSON.parse(told) as Place;
  return { pixels: await createImageBitmap(await answer.blob()), place };
}
