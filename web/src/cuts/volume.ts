// The CT around the navigated vertebra, sent once: voxels, position and named windows.
import type { GetNavigationCtData } from "../api";
import { client } from "../api/client.gen";
import { inverseAffine, type GreyWindow, type Voxels } from "./cut";

export interface Volume {
  ctId: string;
  voxels: Voxels;
  presets: Record<string, GreyWindow>;
}

/**
 * Returns the newest volume; null while the rehearsal's CT is being simulated.
 *
 * @throws Rejection
 */
export async function loadVolume(signal: AbortSignal): Promise<Volume | null> {
  // The generated function returns no headers. Revalidated each time; answered from the browser's cache if unchanged.
  const { data, response } = await client.get<ArrayBuffer, unknown, true>({
    url: "/api/navigation/ct" satisfies GetNavigationCtData["url"],
    parseAs: "arrayBuffer",
    cache: "no-cache",
    signal,
  });
  if (response.status === 204) return null;
  return volumeFrom(response.headers.get("volume-place") ?? "", data);
}

/** Parses an answer; throws if header and voxels do not match. */
function volumeFrom(header: string, content: ArrayBuffer): Volume {
  const { ct_id, size_ijk, lps_from_ijk, presets } = JSON.parse(header) as {
    ct_id: string;
    size_ijk: [number, number, number];
    lps_from_ijk: number[][];
    presets: Record<string, GreyWindow>;
  };
  const hu = new Int16Array(content);
  const [columns, rows, slices] = size_ijk;
  if (hu.length !== columns * rows * slices) {
    throw new Error(`a volume of ${columns} x ${rows} x ${slices} voxels came with ${hu.length}`);
  }
  return {
    ctId: ct_id,
    voxels: { hu, size: size_ijk, indexFromLps: inverseAffine(lps_from_ijk) },
    presets,
  };
}
