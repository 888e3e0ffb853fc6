import { getSurface } from "../../../api";
import { NO_ANSWER, Rejection } from "../../../rest/client";
import { useQuery } from "../../../rest/useQuery";
import { hasDocument } from "../state/documents";
import { trianglesOf, type Triangles } from "./triangles";

/** Last fetched surface, shared by all views. */
let cache: { id: string; triangles: Promise<Triangles | null> } | null = null;

/** Triangles of the case's surface; fetched again when this page made another one. */
export function useTriangles(caseId: string, surfacesMade: number): Triangles | null {
  return useQuery(
    async (signal) => {
      if (!(await hasDocument(caseId, "surface", signal))) return null;
      const { heading } = await getSurface({ signal });
      if (cache?.id !== heading.id) cache = { id: heading.id, triangles: fetched() };
      return cache.triangles;
    },
    { key: `${caseId} ${surfacesMade}` },
  ).data;
}

async function fetched(): Promise<Triangles | null> {
  try {
    const answer = await fetch("/api/surface.ply");
    if (answer.ok) return trianglesOf(await answer.arrayBuffer());
  } catch {
    // Reported elsewhere, like any lost connection.
  }
  cache = null;
  throw new Rejection(NO_ANSWER);
}
