// What is being done on the page: which part of the plan, and what is moved but not kept yet.
import { createContext, use, useCallback, useMemo, useState, type ReactNode } from "react";
import type { Draft } from "../channel/draft";

export const PARTS = ["ct", "pedicle", "channel", "lines", "landmarks", "surface", "file"] as const;
export type Part = (typeof PARTS)[number];

interface WorkValue {
  part: Part;
  setPart: (part: Part) => void;
  /** The channel that is moved by hand; of this vertebra and side alone. */
  draft: { of: string; channel: Draft } | null;
  setDraft: (draft: { of: string; channel: Draft } | null) => void;
  /** Distance of the outer lines from the middle one, on the way to be laid. */
  apartMm: number;
  setApartMm: (apartMm: number) => void;
  /** How often a surface was made while this page is open. */
  surfaces: number;
  refreshSurfaces: () => void;
}

const WorkContext = createContext<WorkValue | null>(null);
const USUAL_APART_MM = 20;

export function WorkProvider({ children }: { children: ReactNode }): ReactNode {
  const [part, setPart] = useState<Part>("pedicle");
  const [draft, setDraft] = useState<WorkValue["draft"]>(null);
  const [apartMm, setApartMm] = useState(USUAL_APART_MM);
  const [surfaces, setSurfaces] = useState(0);
  const refreshSurfaces = useCallback(() => {
    setSurfaces((before) => before + 1);
  }, []);
  const value = useMemo(
    () => ({ part, setPart, draft, setDraft, apartMm, setApartMm, surfaces, refreshSurfaces }),
    [part, draft, apartMm, surfaces, refreshSurfaces],
  );
  return <WorkContext value={value}>{children}</WorkContext>;
}

export function useWork(): WorkValue {
  const value = use(WorkContext);
  if (value === null) throw new Error("useWork must be used inside WorkProvider");
  return value;
}
