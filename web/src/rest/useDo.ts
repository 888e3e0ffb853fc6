// Something that a person does: one at a time, with its refusal kept until the next try.
import { useCallback, useRef, useState } from "react";
import { Refusal } from "./client";

export interface Doing {
  busy: boolean;
  refusal: Refusal | null;
  /** Runs it; true when it was done. A second call while one runs does nothing. */
  run: (action: () => Promise<void>) => Promise<boolean>;
  forget: () => void;
}

export function useDo(): Doing {
  const [state, setState] = useState<{ busy: boolean; refusal: Refusal | null }>({
    busy: false,
    refusal: null,
  });
  const running = useRef(false);
  const run = useCallback(async (action: () => Promise<void>): Promise<boolean> => {
    if (running.current) return false;
    running.current = true;
    setState({ busy: true, refusal: null });
    try {
      await action();
      setState({ busy: false, refusal: null });
      return true;
    } catch (error) {
      if (!(error instanceof Refusal)) throw error;
      setState({ busy: false, refusal: error });
      return false;
    } finally {
      running.current = false;
    }
  }, []);
  const forget = useCallback(() => {
    setState({ busy: false, refusal: null });
  }, []);
  return { ...state, run, forget };
}
