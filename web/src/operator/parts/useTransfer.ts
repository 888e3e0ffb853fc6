// One transfer at a time: progress, result and cancelling.
import { useCallback, useEffect, useRef, useState } from "react";
import { Rejection } from "../../rest/client";
import type { TransferredBytes, OnProgress } from "./transfer";

export interface Transfer {
  /** Null while nothing is being transferred. */
  moved: TransferredBytes | null;
  rejection: Rejection | null;
  stopped: boolean;
  run: (move: (onMoved: OnProgress, signal: AbortSignal) => Promise<void>) => Promise<void>;
  stop: () => void;
}

const NOTHING = { moved: null, rejection: null, stopped: false };

export function useTransfer(): Transfer {
  const [state, setState] = useState<Pick<Transfer, "moved" | "rejection" | "stopped">>(NOTHING);
  const control = useRef<AbortController | null>(null);

  useEffect(
    () => () => {
      control.current?.abort();
    },
    [],
  );

  const run = useCallback<Transfer["run"]>(async (move) => {
    if (control.current !== null) return;
    const own = new AbortController();
    control.current = own;
    setState({ ...NOTHING, moved: { doneBytes: 0, allBytes: 0 } });
    try {
      await move((moved) => {
        setState({ ...NOTHING, moved });
      }, own.signal);
      setState(NOTHING);
    } catch (error) {
      if (own.signal.aborted) setState({ ...NOTHING, stopped: true });
      else if (error instanceof Rejection) setState({ ...NOTHING, rejection: error });
      else throw error;
    } finally {
      control.current = null;
    }
  }, []);

  const stop = useCallback(() => {
    control.current?.abort();
  }, []);
  return { ...state, run, stop };
}
