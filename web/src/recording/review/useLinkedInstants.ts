// The instants of two recordings, linked by an offset: the one that was not moved follows the other.
import { useEffect, useState } from "react";
import { getRecordingsByNameNearest } from "../../api";
import { Rejection } from "../../rest/client";
import { useShownInstant, type ShownInstant } from "./useShownInstant";

export interface LinkedSide {
  number: number;
  shown: ShownInstant;
  isLoading: boolean;
  /** Whether the other side follows this one. */
  isLeading: boolean;
  onNumber: (number: number) => void;
}

export interface LinkedInstants {
  sides: [LinkedSide, LinkedSide];
  /** Time of the second minus time of the first; null while they are not linked. */
  offsetS: number | null;
  setOffsetS: (offsetS: number | null) => void;
}

export function useLinkedInstants(names: readonly [string, string]): LinkedInstants {
  const [numbers, setNumbers] = useState<readonly [number, number]>([0, 0]);
  const [leader, setLeader] = useState<0 | 1>(0);
  const [offsetS, setOffsetS] = useState<number | null>(0);
  const first = useShownInstant(names[0], numbers[0]);
  const second = useShownInstant(names[1], numbers[1]);
  const leading = leader === 0 ? first : second;
  const leaderAtS = leading.shown.instant?.at_s ?? null;
  const other = names[leader === 0 ? 1 : 0];
  useEffect(() => {
    if (offsetS === null || leaderAtS === null) return;
    const stop = new AbortController();
    const follow = async (): Promise<void> => {
      const atS = Math.max(leader === 0 ? leaderAtS + offsetS : leaderAtS - offsetS, 0);
      try {
        const path = { name: other };
        const { number } = await getRecordingsByNameNearest({
          path,
          query: { at_s: atS },
          signal: stop.signal,
        });
        if (stop.signal.aborted) return;
        setNumbers((before) => (leader === 0 ? [before[0], number] : [number, before[1]]));
      } catch (error) {
        // It stays where it is, and its instant is then too far away for a difference.
        if (!stop.signal.aborted && !(error instanceof Rejection)) throw error;
      }
    };
    void follow();
    return () => {
      stop.abort();
    };
  }, [leader, leaderAtS, offsetS, other]);
  const side = (place: 0 | 1, { shown, isLoading }: typeof first): LinkedSide => ({
    number: numbers[place],
    shown,
    isLoading,
    isLeading: offsetS === null || leader === place,
    onNumber: (number) => {
      setLeader(place);
      setNumbers((before) => (place === 0 ? [number, before[1]] : [before[0], number]));
    },
  });
  return { sides: [side(0, first), side(1, second)], offsetS, setOffsetS };
}
