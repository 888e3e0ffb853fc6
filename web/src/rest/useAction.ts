// A user action. Only one runs at a time; its rejection is kept until the next attempt.
import { useCallback, useRef, useState } from "react";
import { Rejection } from "./client";

interface Action {
  busy: boolean;
  rejection: Rejection | null;
  /** Runs the action; resolves to true on success. Ignored while one is running. */
  run: (action: () => Promise<void>) => Promise<boolean>;
  forget: () => void;
}

export function useAction(): Action {
  const [state, setState] = useState<{ busy: boolean; rejection: Rejection | null }>({
    busy: false,
    rejection: null,
  });
  const running = useRef(false);
  const run = useCallback(async (action: () => Promise<void>): Promise<boolean> => {
    if (running.current) return false;
    running.current = true;
    setState({ busy: true, rejection: null });
    try {
      await action();
      setState({ busy: false, rejection: null });
      return true;
    } catch (error) {
      if (!(error instanceof Rejection)) throw error;
      setState({ busy: false, rejection: error });
      return false;
    } finally {
      running.current = false;
    }
  }, []);
  const forget = useCallback(() => {
    setState({ busy: false, rejection: null });
  }, []);
  return { ...state, run, forget };
}
