// Unsaved state of the page: the selected part and drafts.
import { createContext, use, useCallback, useMemo, useState, type ReactNode } from "react";
import type { Draft } from "../channel/draft";

export const PARTS = ["ct", "pedicle", "channel", "lines", "landmarks", "surface", "file"] as const;
export type Part = (typeof PARTS)[number];

interface WorkValue {
  part: Part;
  setPart: (part: Part) => void;
  /** The draft channel, of this vertebra and side only. */
  draft: { of: string; channel: Draft } | null;
  setDraft: (draft: { of: string; channel: Draft } | null) => void;
  /** Draft distance of the outer lines from the middle one. */
  apartMm: number;
  setApartMm: (apartMm: number) => void;
  /** Number of surfaces made since the page was opened. */
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
